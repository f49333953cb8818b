#pragma once
/// \file
/// LU factorization without pivoting within the envelope of a matrix whose pattern is symmetric: for row i the columns
/// from the first that has an entry on. Needs no symbolic work, and its loops are dot products of neighbours in memory,
/// so that it beats sparse factorizations as long as the envelope is narrow.
/// A. George, J. W. Liu, Computer Solution of Large Sparse Positive Definite Systems, Prentice-Hall 1981, ch. 4.

#include "systems/solve/gmres.hpp"

namespace minamo {

class EnvelopeLu {
 public:
  /// \param first  column of the first entry of every row, at most the row itself
  void start(const std::vector<std::uint32_t>& first);
  std::size_t rows() const { return first_.size(); }
  /// Entry of the lower or upper part; \pre within the envelope.
  double& at(std::size_t row, std::size_t column) {
    return column < row ? lower_[start_[row] + column - first_[row]] : upper_[start_[column] + row - first_[column]];
  }
  /// False if a pivot is zero or not finite.
  bool factorize();
  /// Overwrites b with the solution.
  void solve(Values& b) const;

  /// About the multiplications of factorize().
  static double cost(const std::vector<std::uint32_t>& first);

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::size_t>
      start_;  ///< of row i of the lower and column i of the upper part; both end with the diagonal
  Values lower_;
  Values upper_;
};

}  // namespace minamo
