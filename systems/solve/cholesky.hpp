#pragma once
/// \file
/// Sparse Cholesky factorization of a symmetric matrix, given row by row: complete, by SuiteSparse's CHOLMOD on one
/// thread, or incomplete, within the pattern of the matrix, by Eigen.
/// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, ACM TOMS 35 (2008) 22, doi:10.1145/1391989.1391995 (CHOLMOD);
/// C.-J. Lin, J. J. Moré, SIAM J. Sci. Comput. 21 (1999) 24, doi:10.1137/S1064827597327334 (incomplete).

#include "systems/solve/gmres.hpp"

#include <memory>

namespace minamo {

class SparseCholesky {
 public:
  enum class Kind { complete, incomplete };

  SparseCholesky();
  ~SparseCholesky();
  /// Starts a matrix without entries.
  void start(std::size_t rows);
  /// The next entry of the lower triangle; rows rise, every entry comes once.
  void add(std::size_t row, std::size_t column, double value);
  /// The symbolic factorization is kept as long as the pattern is. False if the matrix is not positive definite; the
  /// incomplete factorization adds to the diagonal instead, until it is.
  /// \throws std::bad_alloc if the factors do not fit into memory.
  bool factorize(Kind kind = Kind::complete);
  /// Overwrites b with the solution.
  void solve(Values& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace minamo
