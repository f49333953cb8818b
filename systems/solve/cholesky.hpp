#pragma once
/// \file
/// Sparse Cholesky factorization by CHOLMOD of a matrix that is given row by row; the symbolic work is kept while the
/// pattern stays.
/// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, Algorithm 887: CHOLMOD, ACM TOMS 35 (2008) 22,
/// doi:10.1145/1391989.1391995.

#include "systems/solve/gmres.hpp"

#include <memory>

namespace minamo {

class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  void start(std::size_t rows);
  /// Adds an entry of the lower triangle, rows rising, every place once. Columns may come in any order.
  void add(std::size_t row, std::size_t column, double value);
  /// False if the matrix is not positive definite.
  bool factorize();
  /// Overwrites b with the solution.
  void solve(Values& b);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace minamo
