#pragma once
/// \file
/// LU factorization within the pattern of a sparse matrix, ILU(0): what would fall outside is dropped. J. A. Meijerink,
/// H. A. van der Vorst, Math. Comp. 31 (1977) 148, doi:10.1090/S0025-5718-1977-0438681-4.

#include "systems/linear/gmres.hpp"

#include <cstdint>
#include <vector>

namespace minamo {

/// A sparse matrix, row by row; columns rise.
struct SparseRows {
  std::vector<std::uint32_t> begin{0};  ///< of every row among the entries, and the end of the last
  std::vector<std::uint32_t> column;
  Values value;

  std::size_t rows() const { return begin.size() - 1; }
};

class IncompleteLu {
 public:
  /// \pre every row has a diagonal. A pivot far below what its row began with is that instead.
  void factorize(const SparseRows& matrix);
  /// Overwrites b with about the solution.
  void solve(Values& b) const;

 private:
  void eliminate(std::size_t row);

  SparseRows factors_;                   ///< L, whose diagonal is one, and U
  std::vector<std::uint32_t> diagonal_;  ///< place of every row's
  std::vector<std::uint32_t> place_;     ///< work space: of the columns of a row, one behind
  Values per_pivot_;
};

}  // namespace minamo
