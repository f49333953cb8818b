#pragma once
/// \file
/// Decompositions of small dense matrices. They are compiled here once: Eigen's headers take seconds in every source
/// that uses them. Where the size is known at run time only, they are LAPACK's, E. Anderson et al., LAPACK Users' Guide
/// (1999); where that finds none, a result is NaN, and no step is accepted that takes it.

#include <Eigen/Core>

namespace minamo {

/// A^-1 of an n x n matrix, by LU with partial pivoting. \pre it is regular.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A);

/// x with A x = b, A symmetric, by LDL^T. \param b  n \pre A is regular.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
/// The same for n = 2, 3, 4, by Eigen; where A is singular, one of its solutions.
template <int N>
Eigen::Matrix<double, N, 1> solve_small_symmetric(const Eigen::Matrix<double, N, N>& A,
                                                  const Eigen::Matrix<double, N, 1>& b);

/// A V = B V diag(lambda), V^T B V = 1.
struct Modes {
  Eigen::VectorXd lambda;  ///< n, ascending
  Eigen::MatrixXd V;       ///< n x n
};
/// \pre A is symmetric, B symmetric and positive definite.
Modes modes_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace minamo
