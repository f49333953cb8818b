#include "support/dense_equations.hpp"
#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scenes.hpp"

#include "systems/equal_order/schur_operator.hpp"

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A tank of water with a wave on it: nodes deep in it, at walls and at the surface.
template <int Dim>
Json water() {
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1.4, 1.2], "cells": [14, 12]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"where": "y < 0.8 + 0.1*cos(2.2*x)"}, "per_cell": 3}],
    "solver": {"scheme": "umfpack"}, "time": {"end": 1, "step": 0.01}})json");
  if constexpr (Dim == 3) {
    scene["dimension"] = 3;
    scene["grid"] = Json::parse(R"({"low": [0, 0, 0], "high": [1.4, 1.2, 0.5], "cells": [14, 12, 5]})");
    scene["body_force"] = {0, -9.81, 0};
  }
  return of_equal_order(scene);
}

Values random_values(std::size_t count, int seed) {
  kernels::Random random(seed);
  Values v(count);
  for (double& x : v) x = random(-1, 1);
  return v;
}

/// The largest difference, by the largest value of `b`.
double difference(const Values& a, const Values& b) {
  Largest worst;
  Largest largest;
  for (std::size_t i = 0; i < b.size(); ++i) {
    worst.add(std::abs(a[i] - b[i]));
    largest.add(std::abs(b[i]));
  }
  return worst.value() / largest.value();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("products with the rows of (E55) are those of the matrix", "[property][long]", ((int Dim), Dim),
                       2, 3) {
  const std::string quadrature = GENERATE("mixed", "particles");
  CAPTURE(quadrature);
  SceneRun run(with(water<Dim>(), {R"(/quadrature={"scheme": ")" + quadrature + "\"}"}));
  run.step(2);
  SchurOperator<Dim> schur;
  schur.assemble(dense::terms_of_step<Dim>(run.world()));

  const Eigen::MatrixXd matrix = dense::as_assembled<Dim>(run.world()).matrix;
  const Values p = random_values(schur.rows(), 1);
  Values w = random_values(Dim * schur.rows(), 2);
  Values gradient(w.size()), spread(p.size()), gradient_by_matrix(w.size(), 0.0), divergence_by_matrix(p.size(), 0.0);
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (schur.inverse_diagonal()[i] == 0) w[i] = 0;  // towards a wall
  }
  Eigen::VectorXd x(matrix.rows());
  const auto unknown = [](std::size_t r, std::size_t d) { return static_cast<Eigen::Index>((Dim + 1) * r + d); };
  for (std::size_t r = 0; r < p.size(); ++r) {
    for (std::size_t d = 0; d < Dim; ++d) x[unknown(r, d)] = w[Dim * r + d];
    x[unknown(r, Dim)] = p[r];
  }
  for (std::size_t r = 0; r < p.size(); ++r) {
    divergence_by_matrix[r] = matrix.row(unknown(r, Dim)).dot(x);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (schur.inverse_diagonal()[Dim * r + d] == 0) continue;
      for (std::size_t s = 0; s < p.size(); ++s) {
        gradient_by_matrix[Dim * r + d] -= matrix(unknown(r, d), unknown(s, Dim)) * p[s];
      }
    }
  }
  SchurVectors work;
  schur.apply_divergence(w, p, work, spread);
  schur.apply_gradient(p, work, gradient);
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (schur.inverse_diagonal()[i] == 0) gradient[i] = 0;
  }
  CHECK(difference(spread, divergence_by_matrix) < 8e-15);  // sums of 75 and 500 terms: 9e-16 measured
  CHECK(difference(gradient, gradient_by_matrix) < 8e-15);
}
