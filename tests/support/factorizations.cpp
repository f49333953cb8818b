#include "support/factorizations.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace minamo::dense {

Eigen::MatrixXd solve(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.partialPivLu().solve(right);
}

FullyPivoted solve_with_full_pivots(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right, double threshold) {
  Eigen::FullPivLU<Eigen::MatrixXd> lu(matrix);
  lu.setThreshold(threshold);
  return {lu.solve(right), lu.isInvertible()};
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::VectorXcd least_squares(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::MatrixXd pseudoinverse(const Eigen::MatrixXd& matrix, Eigen::Index null_vectors) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  Eigen::VectorXd inverse = eigen.eigenvalues().cwiseInverse();
  inverse.head(null_vectors).setZero();
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace minamo::dense
