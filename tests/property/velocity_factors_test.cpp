#include "support/dense_equations.hpp"
#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scenes.hpp"

#include "components/grid.hpp"
#include "engine/run/step_control.hpp"
#include "systems/equal_order/velocity_factors.hpp"

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A lump on the floor, and a drop on a side wall: the nodes next to it have hardly any mass, but all of the friction.
template <int Dim>
Json lump_and_wet_wall(double viscosity) {
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
    "fluid": {"density": 1000}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0.2, 0], "high": [0.8, 0.5]}}, "per_cell": 2},
                  {"shape": {"box": {"low": [0, 0.75], "high": [0.05, 0.8]}}, "per_cell": 2}],
    "transfer": {"scheme": "tpic"}, "integrator": {"scheme": "midpoint"}, "volume": {"scheme": "none"},
    "solver": {"scheme": "umfpack"},
    "time": {"end": 1, "step": 0.01}})json");
  scene["fluid"]["viscosity"] = viscosity;
  if constexpr (Dim == 3) {
    scene["dimension"] = 3;
    scene["grid"] = Json::parse(R"({"low": [0, 0, 0], "high": [1, 1, 0.3], "cells": [10, 10, 3]})");
    scene["body_force"] = Json({0, -9.81, 0});
    for (auto& region : scene["particles"]) {
      region["shape"]["box"]["low"].push_back(0.1);
      region["shape"]["box"]["high"].push_back(0.2);
    }
  }
  return of_equal_order(scene);
}

template <int Dim>
void press_onto_wall(World& world, double cells) {
  for (auto& x : world.column<particle::Position<Dim>>()) {
    if (x[0] < 0.05) x[0] = cells * world.resource<Grid<Dim>>().spacing;
  }
}

/// A v by the dense matrix of the step.
template <int Dim>
Values times_dense(const Eigen::MatrixXd& matrix, const Values& v) {
  const auto unknown = [](std::size_t i) { return static_cast<Eigen::Index>((Dim + 1) * (i / Dim) + i % Dim); };
  Values out(v.size(), 0.0);
  for (std::size_t i = 0; i < v.size(); ++i) {
    for (std::size_t j = 0; j < v.size(); ++j) out[i] += matrix(unknown(i), unknown(j)) * v[j];
  }
  return out;
}

/// The velocity block of the last step of a run, and what it refers to.
template <int Dim>
struct FactorsOfStep {
  FactorsOfStep(World& world, ViscousSolver solver) {
    const auto terms = dense::terms_of_step<Dim>(world);
    schur.assemble(terms);
    block.prepare(terms, schur, solver);
    viscosity = terms.viscosity;
  }
  void solve(Values& v, double target) { block.solve({schur, viscosity}, v, target, work); }
  Values residual(const Values& u) {
    Values out(u.size());
    block.residual({schur, viscosity}, u, work, out);
    return out;
  }
  SchurOperator<Dim> schur;
  VelocityFactors<Dim> block;
  typename VelocityFactors<Dim>::Viscosity viscosity;
  typename VelocityFactors<Dim>::Work work;
};

/// Right-hand sides of displacements between -1/2 and 1/2, about.
Values random_momentum(const Values& inverse_diagonal) {
  kernels::Random random(3);
  Values v(inverse_diagonal.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double number = random(-0.5, 0.5);
    v[i] = inverse_diagonal[i] == 0 ? 0 : number / inverse_diagonal[i];
  }
  return v;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the velocity block is solved but for a rest that is known and small", "[property]",
                       ((int Dim), Dim), 2, 3) {
  // Water with and without stiff unknowns at a wall, syrup that is stiff in some places, and one that is everywhere.
  const auto [viscosity, cells, is_diagonal, is_exact] =
      GENERATE(table<double, double, bool, bool>({{1e-3, 0.25, true, false},
                                                  {1e-3, 1e-5, false, false},
                                                  {1e-3, 1e-4, false, false},
                                                  {1e2, 1e-5, false, false},
                                                  {1e4, 0.25, false, true}}));
  CAPTURE(viscosity, cells);
  SceneRun run(lump_and_wet_wall<Dim>(viscosity));
  World& world = run.world();
  run.start();
  press_onto_wall<Dim>(world, cells);
  run.step();
  FactorsOfStep<Dim> of_step(world, ViscousSolver::factors);
  const auto& schur = of_step.schur;
  const auto& block = of_step.block;
  CHECK(block.is_diagonal() == is_diagonal);
  CHECK((block.error() == 0) == is_exact);
  CHECK(block.error() <= 0.5);

  const Values v = random_momentum(schur.inverse_diagonal());
  Values x = v;
  of_step.solve(x, 0);
  const Values rest = of_step.residual(x);
  const Values product = times_dense<Dim>(dense::as_assembled<Dim>(world).matrix, x);
  Largest worst;
  Largest left;
  Largest largest;
  for (std::size_t i = 0; i < v.size(); ++i) {
    worst.add(schur.inverse_diagonal()[i] * std::abs(product[i] + rest[i] - v[i]));
    left.add(schur.inverse_diagonal()[i] * std::abs(rest[i]));
    largest.add(std::abs(x[i]));
  }
  // Sums of 50 and 80 terms, and a factorization: 4e-15 measured.
  CHECK(worst.value() < 4e-14 * largest.value());
  CHECK(left.value() <= block.error() * largest.value());
}

TEMPLATE_TEST_CASE_SIG("many stiff velocities are solved by iterations, as exactly as is asked", "[property]",
                       ((int Dim), Dim), 2, 3) {
  SceneRun run(lump_and_wet_wall<Dim>(1e3));
  World& world = run.world();
  run.step();
  FactorsOfStep<Dim> of_step(world, ViscousSolver::iteration);
  const auto& schur = of_step.schur;
  const auto& block = of_step.block;
  REQUIRE(block.is_iteration());
  CHECK_FALSE(block.is_diagonal());

  const Values v = random_momentum(schur.inverse_diagonal());
  const Values& inverse_diagonal = schur.inverse_diagonal();
  const auto size = [&inverse_diagonal](const Values& f) { return std::sqrt(weighted_square(inverse_diagonal, f)); };
  const double asked = GENERATE(1e-2, 1e-5, 0.0);
  CAPTURE(asked);
  Values x = v;
  of_step.solve(x, asked * size(v));
  const Values rest = of_step.residual(x);
  CHECK(size(rest) <= std::max(asked, 1e-7) * size(v));
  CHECK(size(rest) > 0.1 * asked * size(v));  // no more work than that; 0.4 measured
  Values error = times_dense<Dim>(dense::as_assembled<Dim>(world).matrix, x);
  for (std::size_t i = 0; i < v.size(); ++i) error[i] += rest[i] - v[i];
  CHECK(size(error) < 5e-15 * size(v));  // 5e-16 measured

  Values broken(v.size(), std::nan(""));
  CHECK_THROWS_AS(of_step.solve(broken, 0), StepRejected);
}

TEST_CASE("iterations are preferred where many velocities are stiff, but not too much", "[property]") {
  // Friction below and twenty times the inertia on 6000 unknowns, and of once on 200.
  const auto [cells, viscosity, is_iteration] =
      GENERATE(table<int, double, bool>({{100, 5, true}, {100, 160, false}, {16, 300, false}}));
  CAPTURE(cells, viscosity);
  SceneRun run(with(lump_and_wet_wall<2>(viscosity),
                    {"/grid/cells=[" + std::to_string(cells) + ", " + std::to_string(cells) + "]",
                     R"(/solver={"scheme": "block"})"}));
  run.step();
  const FactorsOfStep<2> of_step(run.world(), ViscousSolver::cheapest);
  CHECK_FALSE(of_step.block.is_diagonal());
  CHECK(of_step.block.is_iteration() == is_iteration);
}

TEST_CASE("iterations are preferred sooner in 3-D, where factors fill in", "[property]") {
  // Friction of once and fifty times the inertia on some hundred unknowns.
  const double viscosity = GENERATE(100.0, 5000.0);
  CAPTURE(viscosity);
  SceneRun run(with(lump_and_wet_wall<3>(viscosity), {R"(/solver={"scheme": "block"})"}));
  run.step();
  const FactorsOfStep<3> of_step(run.world(), ViscousSolver::cheapest);
  CHECK_FALSE(of_step.block.is_diagonal());
  CHECK(of_step.block.is_iteration() == (viscosity < 1000));
}
