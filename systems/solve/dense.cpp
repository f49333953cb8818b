#include "systems/solve/dense.hpp"

#include <Eigen/Dense>

namespace minamo {

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A) { return A.inverse(); }

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) { return A.ldlt().solve(b); }

Modes modes_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(A, B);
  return {modes.eigenvalues(), modes.eigenvectors()};
}

}  // namespace minamo
