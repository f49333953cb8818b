#pragma once
/// \file
/// Cholesky factorization of a symmetric positive definite matrix within its envelope: for row i the columns from the
/// first that has an entry on, in square tiles as wide as a vector register. What EnvelopeLu is for matrices that are
/// not symmetric. A. George, J. W. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall
/// 1981, ch. 4.

#include "components/types.hpp"

#include <cstring>
#include <span>
#include <vector>

namespace minamo {

class EnvelopeCholesky {
 public:
  /// Up to four right-hand sides of a row, side by side.
  struct Row {
    Four lane;
  };

  /// All entries are zero. \param first  column of the first entry of every row, at most the row itself
  void start(std::span<const std::uint32_t> first);
  /// Entry of the lower part; \pre within the envelope.
  double& at(std::size_t row, std::size_t column) {
    const std::size_t i = row / width;
    return tiles_[start_[i] + column / width - first_[i]](row % width, column % width);
  }
  /// False if a pivot is not positive.
  bool factorize();
  /// Overwrites right-hand sides with solutions; \pre as many rows as padded_rows(), those beyond the matrix' finite.
  void solve(std::span<Row> x) const;
  /// Rows, rounded up to whole tiles.
  std::size_t padded_rows() const { return width * first_.size(); }

 private:
  static constexpr std::size_t width = 4;
  /// Column by column. On the diagonal the inverse of the factor's tile.
  struct Tile {
    alignas(sizeof(Four)) std::array<double, width * width> entry;
    double operator()(std::size_t row, std::size_t column) const { return entry[column * width + row]; }
    double& operator()(std::size_t row, std::size_t column) { return entry[column * width + row]; }
    Four column(std::size_t j) const {
      Four column;
      std::memcpy(&column, entry.data() + j * width, sizeof column);
      return column;
    }
    void set_column(std::size_t j, const Four& column) {
      std::memcpy(entry.data() + j * width, &column, sizeof column);
    }
  };
  void place_tiles(std::span<const std::uint32_t> first);
  /// c -= sum of a_k b_k^T
  static void subtract_products(const Tile* a, const Tile* b, std::size_t count, Tile& c);
  static void times_transposed(Tile& a, const Tile& lower);
  static bool invert_factor(Tile& a);
  void eliminate(std::span<Row> x) const;
  void substitute(std::span<Row> x) const;

  std::vector<std::uint32_t> first_;  ///< tile of every row of tiles
  std::vector<std::size_t> start_;    ///< of every row of tiles, up to and with the diagonal
  std::vector<Tile> tiles_;
};

/// About the floating-point operations of EnvelopeCholesky::factorize().
double envelope_work(std::span<const std::uint32_t> first);

}  // namespace minamo
