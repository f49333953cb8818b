#pragma once
/// \file
/// Solutions by Eigen's dense factorizations. They stand in a source of their own because each takes seconds to compile
/// wherever it is used.

#include <Eigen/Core>
#include <complex>

namespace minamo::dense {

/// Solves matrix x = right, with partial pivoting. \pre the matrix is square and regular
Eigen::MatrixXd solve(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// A solution with full pivoting.
struct FullyPivoted {
  Eigen::VectorXd x;
  bool is_regular = false;  ///< no pivot lies below the threshold
};

/// Solves matrix x = right, as far as that has a solution. Pivots below `threshold` times the largest count as zero.
FullyPivoted solve_with_full_pivots(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                    double threshold = 1e-14);

/// The x of least |matrix x - right|, column by column.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
Eigen::VectorXcd least_squares(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right);

/// In ascending order. \pre the matrix is symmetric
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// The inverse without the eigenvectors of the `null_vectors` smallest eigenvalues.
/// \pre the matrix is symmetric and positive semidefinite
Eigen::MatrixXd pseudoinverse(const Eigen::MatrixXd& matrix, Eigen::Index null_vectors);

}  // namespace minamo::dense
