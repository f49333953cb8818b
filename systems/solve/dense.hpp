#pragma once
/// \file
/// Decompositions of small dense matrices whose size is known at run time. They are compiled here once: the headers of
/// Eigen's take seconds in every source that uses them.

#include <Eigen/Core>

namespace minamo {

/// A^-1 of an n x n matrix, by LU with partial pivoting. \pre it is regular
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A);

/// x with A x = b, A symmetric, by LDL^T. \param b  n \pre A is regular
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// A V = B V diag(lambda), V^T B V = 1.
struct Modes {
  Eigen::VectorXd lambda;  ///< n, ascending
  Eigen::MatrixXd V;       ///< n x n
};
/// \pre A is symmetric, B symmetric and positive definite
Modes modes_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace minamo
