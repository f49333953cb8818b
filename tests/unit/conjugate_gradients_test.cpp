#include "support/factorizations.hpp"

#include "systems/linear/conjugate_gradients.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

constexpr Eigen::Index rows = 40;

/// Springs between neighbours, and to the ground from stiffnesses of 1e-3 to 1e3.
Eigen::MatrixXd chain() {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    a(i, i) += std::pow(10, 6.0 * static_cast<double>(i) / (rows - 1) - 3);
    if (i == 0) continue;
    a(i, i) += 1;
    a(i - 1, i - 1) += 1;
    a(i, i - 1) = a(i - 1, i) = -1;
  }
  return a;
}

Values as_values(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }
Eigen::Map<const Eigen::VectorXd> as_vector(const Values& x) { return {x.data(), static_cast<Eigen::Index>(x.size())}; }

struct Times {
  Eigen::MatrixXd a;
  void operator()(const Values& x, Values& out) const {
    Eigen::Map<Eigen::VectorXd>(out.data(), a.rows()) = a * as_vector(x);
  }
};

}  // namespace

TEST_CASE("conjugate gradients solve what a dense factorization solves", "[unit]") {
  const Times times{chain()};
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(rows, -1, 3);
  const Values per_diagonal = as_values(times.a.diagonal().cwiseInverse());
  ConjugateGradients solver;
  Values rest = as_values(b);
  Values x;
  const auto report = solver.solve(times, per_diagonal, 1e-10, 100, rest, x);
  CHECK(report.converged);
  CHECK(report.residual <= 1e-10);
  CHECK(report.iterations < rows);
  const Eigen::VectorXd exact = dense::solve(times.a, b);
  CHECK((as_vector(x) - exact).norm() < 6e-13 * exact.norm());  // 3e-13 measured
  CHECK((b - times.a * as_vector(x) - as_vector(rest)).norm() < 5e-14 * b.norm());
}

TEST_CASE("conjugate gradients leave alone what has no diagonal", "[unit]") {
  Times times{chain()};
  // Walls: the matrix has no such row and column.
  times.a.row(3).setZero();
  times.a.col(3).setZero();
  Values per_diagonal = as_values(times.a.diagonal().cwiseInverse());
  per_diagonal[3] = 0;
  Values rest(rows, 1.0);
  rest[3] = 0;
  Values x;
  CHECK(ConjugateGradients().solve(times, per_diagonal, 1e-10, 100, rest, x).converged);
  CHECK(x[3] == 0);
  CHECK(rest[3] == 0);
}

TEST_CASE("conjugate gradients tell what they have not reached", "[unit]") {
  const Times times{chain()};
  const Values per_diagonal = as_values(times.a.diagonal().cwiseInverse());
  ConjugateGradients solver;
  Values x;
  Values rest(rows, 1.0);
  const auto cut = solver.solve(times, per_diagonal, 1e-10, 5, rest, x);
  CHECK_FALSE(cut.converged);
  CHECK(cut.iterations == 5);
  CHECK(cut.residual > 1e-10);
  rest.assign(rows, std::nan(""));
  CHECK_FALSE(solver.solve(times, per_diagonal, 1e-10, 100, rest, x).converged);
  rest.assign(rows, 0.0);
  const auto nothing = solver.solve(times, per_diagonal, 0, 100, rest, x);
  CHECK(nothing.converged);
  CHECK(nothing.iterations == 0);
}
