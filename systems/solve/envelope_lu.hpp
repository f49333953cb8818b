#pragma once
/// \file
/// LU factorization without pivoting within the envelope of a matrix whose pattern is symmetric: for row i the columns
/// from the first that has an entry on, in square tiles as wide as a vector register. Needs no symbolic work and
/// streams through memory, so that it beats sparse factorizations as long as the envelope is narrow. A. George, J. W.
/// Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall 1981, ch. 4.

#include "systems/solve/gmres.hpp"

#include <Eigen/Core>

#include <span>

namespace minamo {

class EnvelopeLu {
 public:
  /// \param first  column of the first entry of every row, at most the row itself
  void start(std::span<const std::uint32_t> first);
  std::size_t rows() const { return rows_; }
  /// Entry of the lower or upper part; \pre within the envelope.
  double& at(std::size_t row, std::size_t column) {
    const auto [j, of_row] = place(row);
    const auto [i, of_column] = place(column);
    Tile& tile = i < j ? lower_[start_[j] + i - first_[j]] : upper_[start_[i] + j - first_[i]];
    return tile(of_row, of_column);
  }
  /// False if a pivot is zero or not finite.
  bool factorize();
  /// Overwrites b with the solution.
  void solve(Values& b);

 private:
  static constexpr std::size_t width = 4;
  using Tile = Eigen::Matrix<double, width, width>;
  using Lanes = Eigen::Array<double, width, 1>;
  using Columns = std::array<Lanes, width>;
  struct Place {
    std::size_t tile;
    Eigen::Index within;
  };
  static Place place(std::size_t row) { return {row / width, static_cast<Eigen::Index>(row % width)}; }
  void place_tiles(std::span<const std::uint32_t> first);
  static Lanes column_of(const Tile& tile, std::size_t j);
  static void add_product(const Tile& a, const Tile& b, Columns& c);
  static Tile product(const Tile& a, const Tile& b);
  static Lanes product(const Tile& a, const Lanes& x);
  static void subtract_products(const Tile* lower, const Tile* upper, std::size_t count, Tile& from);
  void eliminate_from(std::size_t j);
  void eliminate();
  void substitute();
  bool invert_diagonal(std::size_t j);

  std::size_t rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< tile of every row of tiles
  std::vector<std::size_t> start_;    ///< of row j of the lower and column j of the upper part
  std::vector<Tile> lower_;           ///< row by row, up to and with an unused diagonal
  std::vector<Tile> upper_;           ///< column by column, up to and with the diagonal
  std::vector<Tile> inverse_lower_;   ///< of the diagonal tiles' factors
  std::vector<Tile> inverse_upper_;
  std::vector<Lanes> x_;
};

/// About the multiplications of EnvelopeLu::factorize().
double envelope_cost(std::span<const std::uint32_t> first);

}  // namespace minamo
