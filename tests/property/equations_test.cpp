#include "support/dense_equations.hpp"
#include "support/extremes.hpp"
#include "support/factorizations.hpp"

#include "components/fluid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// Liquid of scattered particles in a corner of a small box, walls of both kinds, a force that varies in space and
/// time, a flow that is neither affine nor free of divergence; and a far particle of 1/256 of a cell, so that some
/// nodes are light.
template <int Dim>
Json scattered() {
  if constexpr (Dim == 2) {
    return Json::parse(R"json({
      "dimension": 2,
      "grid": {"low": [-1, 2], "high": [0.75, 3.5], "cells": [7, 6]},
      "walls": {"x": ["slip", "no_slip"], "y": "slip"},
      "fluid": {"density": 800, "viscosity": 30},
      "body_force": ["3*y + t", "-9.81 + x"],
      "particles": [
        {"shape": {"box": {"low": [-1, 2], "high": [0.75, 2.5]}}, "per_cell": 2,
         "arrangement": "jittered", "seed": 3, "velocity": ["sin(3*x)*y", "x*x - y"]},
        {"shape": {"box": {"low": [0.11, 3.11], "high": [0.125, 3.125]}}, "per_cell": 16, "velocity": [1, 2]}],
      "transfer": {"scheme": "tpic", "inertia": "lumped", "spin": "gradient"},
      "stabilization": {"scheme": "pspg"}, "volume": {"scheme": "none"}, "solver": {"scheme": "umfpack"},
      "time": {"end": 1, "step": 0.01}})json");
  } else {
    return Json::parse(R"json({
      "dimension": 3,
      "grid": {"low": [-1, 2, 0], "high": [0, 2.75, 1], "cells": [4, 3, 4]},
      "walls": {"x": ["slip", "no_slip"], "y": "slip", "z": ["no_slip", "slip"]},
      "fluid": {"density": 800, "viscosity": 30},
      "body_force": ["3*y + t", "-9.81 + x", "z"],
      "particles": [
        {"shape": {"box": {"low": [-1, 2, 0], "high": [0, 2.25, 0.5]}}, "per_cell": 2,
         "arrangement": "jittered", "seed": 3, "velocity": ["sin(3*x)*y", "x*x - y", "z*x"]},
        {"shape": {"box": {"low": [-0.5, 2.5, 0.75], "high": [-0.484, 2.516, 0.766]}}, "per_cell": 16,
         "velocity": [1, 2, 3]}],
      "transfer": {"scheme": "tpic", "inertia": "lumped", "spin": "gradient"},
      "stabilization": {"scheme": "pspg"}, "volume": {"scheme": "none"}, "solver": {"scheme": "umfpack"},
      "time": {"end": 1, "step": 0.01}})json");
  }
}

Json variant(const Json& scene) {
  const std::string integrator = GENERATE("newmark", "midpoint");
  const std::string viscosity = GENERATE("0", "30");
  return with(scene, {"/integrator={\"scheme\": \"" + integrator + "\"}", "/fluid/viscosity=" + viscosity});
}

template <int Dim>
std::size_t ballistic_nodes(World& world) {
  std::size_t count = 0;
  const auto m_i = world.column<node::Mass>();
  const auto row = world.column<node::Row>();
  for (std::size_t i = 0; i < row.size(); ++i) count += m_i[i] > 0 && row[i] < 0;
  return count;
}

/// Largest difference of a block (velocity or pressure rows, velocity or pressure columns), over its largest entry.
double block_difference(const Eigen::MatrixXd& got, const Eigen::MatrixXd& expected, int dim, bool pressure_row,
                        bool pressure_column) {
  Largest largest;
  Largest worst;
  for (Eigen::Index i = 0; i < got.rows(); ++i) {
    for (Eigen::Index j = 0; j < got.cols(); ++j) {
      if ((i % (dim + 1) == dim) != pressure_row || (j % (dim + 1) == dim) != pressure_column) continue;
      largest.add(std::abs(expected(i, j)));
      worst.add(std::abs(got(i, j) - expected(i, j)));
    }
  }
  REQUIRE(largest.value() > 0);
  return worst.value() / largest.value();
}

/// The same for vectors.
double part_difference(const Eigen::VectorXd& got, const Eigen::VectorXd& expected, int dim, bool pressure) {
  return block_difference(got.transpose(), expected.transpose(), dim, false, pressure);
}

// Sums over some 50 particles, through moments whose coefficients cancel: 1e-15 measured.
constexpr double rounding_of_assembly = 3e-15;

}  // namespace

TEMPLATE_TEST_CASE_SIG("the scattered scene has ballistic nodes and active nodes at walls", "[property]",
                       ((int Dim), Dim), 2, 3) {
  SceneRun run(scattered<Dim>());
  run.step();
  CHECK(ballistic_nodes<Dim>(run.world()) > 0);
  const auto fixed = run.world().template column<node::Constraint>();
  const auto row = run.world().template column<node::Row>();
  std::size_t held = 0;
  for (std::size_t i = 0; i < row.size(); ++i) held += row[i] >= 0 && fixed[i] != 0;
  CHECK(held > 0);
}

TEMPLATE_TEST_CASE_SIG("the assembled matrix is the discrete equations", "[property]", ((int Dim), Dim), 2, 3) {
  SceneRun run(variant(scattered<Dim>()));
  CAPTURE(run.scene().schemes, run.scene().facts.get<Fluid>().viscosity);
  run.step();
  const auto got = dense::as_assembled<Dim>(run.world()).matrix;
  const auto expected = dense::assemble<Dim>(run).matrix;
  REQUIRE(got.rows() == expected.rows());
  CHECK(block_difference(got, expected, Dim, false, false) < rounding_of_assembly);
  CHECK(block_difference(got, expected, Dim, false, true) < rounding_of_assembly);
  CHECK(block_difference(got, expected, Dim, true, false) < rounding_of_assembly);
  CHECK(block_difference(got, expected, Dim, true, true) < rounding_of_assembly);
}

TEST_CASE("nodes whose entries of the Laplacian cancel are still coupled", "[property]") {
  // One particle in the middle of every cell: grad S_I . grad S_J of neighbours along an axis cancels to the bit.
  SceneRun run(with(scattered<2>(), {R"(/particles=[{"shape": {"where": "1"}, "per_cell": 1}])"}));
  run.step();
  const auto got = dense::as_assembled<2>(run.world()).matrix;
  const auto expected = dense::assemble<2>(run).matrix;
  CHECK(block_difference(got, expected, 2, false, true) < rounding_of_assembly);
  CHECK(block_difference(got, expected, 2, true, false) < 1e-14);  // 5e-15 measured
}

TEMPLATE_TEST_CASE_SIG("the assembled right-hand side is the discrete equations", "[property]", ((int Dim), Dim), 2,
                       3) {
  SceneRun run(variant(scattered<Dim>()));
  CAPTURE(run.scene().schemes, run.scene().facts.get<Fluid>().viscosity);
  run.step();
  const auto got = dense::as_assembled<Dim>(run.world()).right_hand_side;
  const auto expected = dense::assemble<Dim>(run).right_hand_side;
  REQUIRE(got.rows() == expected.rows());
  CHECK(part_difference(got, expected, Dim, false) < rounding_of_assembly);
  CHECK(part_difference(got, expected, Dim, true) < rounding_of_assembly);
}

/// Rows and columns are scaled first: entries are forces, rates of volume and more, of a cell and of 1/256 of one.
Eigen::VectorXd dense_solution(const dense::Equations& equations) {
  const Eigen::VectorXd of_row = equations.matrix.cwiseAbs().rowwise().maxCoeff().cwiseInverse();
  const Eigen::MatrixXd rows_scaled = of_row.asDiagonal() * equations.matrix;
  const Eigen::VectorXd of_column = rows_scaled.cwiseAbs().colwise().maxCoeff().cwiseInverse();
  const auto [x, is_regular] = dense::solve_with_full_pivots(rows_scaled * of_column.asDiagonal(),
                                                             of_row.cwiseProduct(equations.right_hand_side), 1e-15);
  REQUIRE(is_regular);
  return of_column.cwiseProduct(x);
}

TEMPLATE_TEST_CASE_SIG("the solution is that of dense Gauss elimination with full pivoting", "[property]",
                       ((int Dim), Dim), 2, 3) {
  SceneRun run(variant(scattered<Dim>()));
  CAPTURE(run.scene().schemes, run.scene().facts.get<Fluid>().viscosity);
  run.step();
  const auto equations = dense::as_assembled<Dim>(run.world());
  const Eigen::VectorXd expected = dense_solution(equations);
  const Eigen::VectorXd got = dense::solution<Dim>(run.world());
  CHECK(part_difference(got, expected, Dim, false) < 6e-14);  // 7e-15 measured
  // The far particle's pressures hang on (E27) alone: condition 1/eps = 1e6 times rounding, 2e-10 measured.
  CHECK(part_difference(got, expected, Dim, true) < 1e-9);
}

TEMPLATE_TEST_CASE_SIG("the reported residual is |b - A x| / |b| and small", "[property]", ((int Dim), Dim), 2, 3) {
  SceneRun run(variant(scattered<Dim>()));
  CAPTURE(run.scene().schemes, run.scene().facts.get<Fluid>().viscosity);
  run.step();
  const auto equations = dense::as_assembled<Dim>(run.world());
  const Eigen::VectorXd x = dense::solution<Dim>(run.world());
  const double residual = (equations.right_hand_side - equations.matrix * x).norm() / equations.right_hand_side.norm();
  const double reported = run.world().template resource<SolveReport>().residual;
  CHECK(std::abs(reported - residual) < 3e-15);  // rounding of the products themselves
  // Elimination with partial pivoting and a step of refinement leaves roundings: 5e-16 measured.
  CHECK(reported < 5e-15);
}

TEMPLATE_TEST_CASE_SIG("a ballistic node flies freely, an active one takes the solution", "[property]",
                       ((int Dim), Dim), 2, 3) {
  SceneRun run(with(scattered<Dim>(), {R"(/integrator={"scheme": "midpoint"})"}));
  run.step();
  World& world = run.world();
  const double dt = world.template resource<Clock>().step;
  const auto row = world.template column<node::Row>();
  const auto fixed = world.template column<node::Constraint>();
  const auto m_i = world.template column<node::Mass>();
  const auto u_i = world.template column<node::Displacement<Dim>>();
  const auto v_i = world.template column<node::Velocity<Dim>>();
  const auto b_i = world.template column<node::BodyForce<Dim>>();
  const Eigen::VectorXd solution = dense::solution<Dim>(world);
  Largest worst;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      double expected = 0;
      if (row[i] >= 0) {
        expected = solution[row[i] * (Dim + 1) + d];
      } else if (m_i[i] > 0 && (fixed[i] >> d & 1) == 0) {
        expected = dt * v_i[i][d] + dt * dt / 2 * b_i[i][d];
      }
      worst.add(std::abs(u_i[i][d] - expected));
    }
  }
  CHECK(worst.value() < 1e-16);  // displacements of 0.03 m, a few roundings
}
