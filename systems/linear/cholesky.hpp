#pragma once
/// \file
/// Sparse Cholesky factorization of a symmetric matrix, given entry by entry, by SuiteSparse's CHOLMOD on one thread.
/// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, ACM TOMS 35 (2008) 22, doi:10.1145/1391989.1391995.

#include "systems/linear/gmres.hpp"

#include <memory>

namespace minamo {

class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  /// Starts a matrix without entries.
  void start(std::size_t rows);
  /// Adds to an entry of the lower triangle.
  void add(std::size_t row, std::size_t column, double value);
  /// The symbolic factorization is kept as long as the pattern is. False if the matrix is not positive definite.
  /// \throws std::bad_alloc if the factors do not fit into memory.
  bool factorize();
  /// Overwrites b with the solution.
  void solve(Values& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace minamo
