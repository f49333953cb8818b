#pragma once
/// \file
/// LU factorization without pivoting within the envelope of a matrix whose pattern is symmetric: for row i the columns
/// from the first that has an entry on, in square tiles as wide as a vector register. Needs no symbolic work and
/// streams through memory, so that it beats sparse factorizations as long as the envelope is narrow. A. George, J. W.
/// Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall 1981, ch. 4.

#include "systems/linear/gmres.hpp"

#include <Eigen/Core>

#include <span>

namespace minamo {

class EnvelopeLu {
 public:
  /// All entries are zero. \param first  column of the first entry of every row, at most the row itself
  void start(std::span<const std::uint32_t> first);
  /// Entry of the lower or upper part; \pre within the envelope.
  double& at(std::size_t row, std::size_t column) {
    const std::size_t j = row / width;
    const std::size_t i = column / width;
    Tile& tile = i < j ? lower_[start_[j] + i] : upper_[start_[i] + j];
    return tile(static_cast<Eigen::Index>(row % width), static_cast<Eigen::Index>(column % width));
  }
  /// False if a tile of the diagonal becomes singular.
  bool factorize();
  /// Overwrites b with the solution.
  void solve(Values& b);

 private:
  static constexpr std::size_t width = 4;
  using Tile = Eigen::Matrix<double, width, width>;
  using Part = Eigen::Matrix<double, width, 1>;

  std::vector<std::uint32_t> first_;  ///< tile of every row of tiles
  std::vector<std::size_t> start_;    ///< where the tiles of a row would begin if all had one
  std::vector<Tile> lower_;           ///< row by row, up to and with an unused diagonal
  std::vector<Tile> upper_;           ///< column by column, up to and with the diagonal, whose inverse that is
  std::vector<Part> x_;
};

/// About the multiplications of EnvelopeLu::factorize().
double envelope_cost(std::span<const std::uint32_t> first);

}  // namespace minamo
