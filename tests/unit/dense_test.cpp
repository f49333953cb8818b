/// \file
/// Decompositions of small dense matrices, against what they are defined by.

#include "support/kernels.hpp"

#include "systems/linear/dense.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;

namespace {

Eigen::MatrixXd square_of_random_numbers(kernels::Random& random, int n) {
  Eigen::MatrixXd A(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) A(i, j) = random.vector<2>(-1, 1)[0];
  }
  return A;
}

}  // namespace

TEST_CASE("dense matrices are inverted, and systems with them solved", "[unit]") {
  const int n = GENERATE(1, 2, 3, 6, 40);
  CAPTURE(n);
  kernels::Random random(7);
  const Eigen::MatrixXd any = square_of_random_numbers(random, n) + 3 * Eigen::MatrixXd::Identity(n, n);
  CHECK((inverse_of(any) * any - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-11);
  // Neither positive nor negative definite.
  Eigen::MatrixXd symmetric = any + any.transpose();
  symmetric(0, 0) = -2;
  const Eigen::VectorXd b = any.col(0);
  CHECK((symmetric * solve_symmetric(symmetric, b) - b).norm() < 1e-11);
  const Eigen::Matrix3d three = Eigen::Vector3d(2, -1, 3).asDiagonal();
  CHECK((three * solve_small_symmetric<3>(three, Eigen::Vector3d(1, 2, 3)) - Eigen::Vector3d(1, 2, 3)).norm() < 1e-14);
}

TEST_CASE("modes of two dense matrices diagonalize both, in rising order", "[unit]") {
  const int n = GENERATE(1, 3, 6, 18);
  CAPTURE(n);
  kernels::Random random(8);
  const Eigen::MatrixXd R = square_of_random_numbers(random, n);
  const Eigen::MatrixXd A = R + R.transpose();
  const Eigen::MatrixXd B = R * R.transpose() + Eigen::MatrixXd::Identity(n, n);
  const Modes modes = modes_of(A, B);
  CHECK((modes.V.transpose() * B * modes.V - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-12);
  CHECK((A * modes.V - B * modes.V * modes.lambda.asDiagonal()).norm() < 1e-11);
  for (int k = 1; k < n; ++k) CHECK(modes.lambda[k] >= modes.lambda[k - 1]);
}

TEST_CASE("dense matrices that cannot be decomposed give no numbers", "[unit]") {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(3, 3);
  CHECK(std::isnan(inverse_of(zero)(0, 0)));
  CHECK(std::isnan(solve_symmetric(zero, Eigen::VectorXd::Ones(3))[0]));
  CHECK(std::isnan(modes_of(zero, zero).lambda[0]));
  CHECK(inverse_of(Eigen::MatrixXd(0, 0)).size() == 0);
}
