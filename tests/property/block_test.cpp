#include "support/build.hpp"
#include "support/dense_equations.hpp"
#include "support/extremes.hpp"
#include "support/factorizations.hpp"
#include "support/scenes.hpp"

#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/measure.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "systems/linear/cholesky.hpp"
#include "systems/linear/envelope_lu.hpp"
#include "systems/linear/gmres.hpp"
#include "systems/linear/incomplete_lu.hpp"

#include <random>

using namespace minamo;
using namespace std::string_literals;
using namespace minamo::scene_run;

namespace {

/// A lump in the corner of a box, a far particle, walls of both kinds; thick or thin as `viscosity` says.
template <int Dim>
Json lump_and_drop(double viscosity) {
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 0.8], "cells": [10, 8]},
    "walls": {"x": ["slip", "no_slip"], "y": "slip"},
    "fluid": {"density": 800}, "body_force": ["1 + y", -9.81],
    "particles": [
      {"shape": {"box": {"low": [0, 0], "high": [0.5, 0.4]}}, "per_cell": 2, "arrangement": "jittered", "seed": 3,
       "velocity": ["sin(3*x)*y", "x*x - y"]},
      {"shape": {"box": {"low": [0.81, 0.61], "high": [0.82, 0.62]}}, "per_cell": 10, "velocity": [1, 2]}],
    "transfer": {"scheme": "tpic"}, "integrator": {"scheme": "midpoint"}, "volume": {"scheme": "projection"},
    "time": {"end": 1, "step": 0.01}})json");
  scene["fluid"]["viscosity"] = viscosity;
  if constexpr (Dim == 3) {
    scene["dimension"] = 3;
    scene["grid"] = Json::parse(R"({"low": [0, 0, 0], "high": [1, 0.8, 0.4], "cells": [10, 8, 4]})");
    scene["body_force"] = Json({"1 + y", -9.81, "x"});
    for (auto& region : scene["particles"]) {
      auto& box = region["shape"]["box"];
      box["low"].push_back(box["low"][1]);
      box["high"].push_back(box["high"][1]);
      region["velocity"].push_back(0.5);
    }
    scene["particles"][1]["shape"]["box"]["low"][2] = 0.21;
    scene["particles"][1]["shape"]["box"]["high"][2] = 0.22;
  }
  return of_equal_order(scene);
}

/// Largest distance of particles of two runs, in units of h.
template <int Dim>
double distance(SceneRun& a, SceneRun& b) {
  const auto x_a = by_id<particle::Position<Dim>>(a.world());
  const auto x_b = by_id<particle::Position<Dim>>(b.world());
  Largest largest;
  for (std::size_t p = 0; p < x_a.size(); ++p) largest.add((x_a[p] - x_b[p]).norm());
  return largest.value() / a.world().resource<Grid<Dim>>().spacing;
}

/// A matrix with a symmetric pattern of the given half width, its symmetric part positive definite.
Eigen::MatrixXd random_band(int rows, int half_width, double skewness) {
  std::mt19937 engine(7);
  const auto number = [&] { return static_cast<double>(engine()) / 4294967296.0 - 0.5; };
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, rows);
  for (int i = 0; i < rows; ++i) {
    a(i, i) = half_width;
    for (int j = std::max(0, i - half_width); j < i; ++j) {
      const double s = number();
      const double skew = skewness * number();
      a(i, j) = s + skew;
      a(j, i) = s - skew;
    }
  }
  return a;
}

Values as_values(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }

double difference(const Values& x, const Eigen::VectorXd& y) {
  return (Eigen::Map<const Eigen::VectorXd>(x.data(), y.size()) - y).norm() / y.norm();
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the block solver gives the steps of UMFPACK", "[property][long]", ((int Dim), Dim), 2, 3) {
  // mu dt/(rho h^2) from 0 to 125, through the diagonal velocity block and the factorized one.
  const double viscosity = GENERATE(0.0, 1e-3, 3.0, 1e2, 1e5);
  // The residual of the stiffest liquid does not fall below 3e-10 of its right-hand side, which is rounding.
  const double tolerance = viscosity > 1e4 ? 1e-9 : 1e-11;
  const std::string stabilization = GENERATE("pspg", "oss", "vms");
  const std::string integrator = GENERATE("midpoint", "newmark");
  CAPTURE(viscosity, stabilization, integrator);
  // In 3-D, where a step costs fifty times as much, each viscosity with every stabilization, in turn with either.
  const bool newmark_is_next = (viscosity > 2) == (stabilization == "oss");
  if (Dim == 3 && newmark_is_next != (integrator == "newmark")) return;
  const Json scene = with(lump_and_drop<Dim>(viscosity), {R"(/stabilization={"scheme": ")" + stabilization + "\"}",
                                                          R"(/integrator={"scheme": ")" + integrator + "\"}"});
  SceneRun block(
      with(scene, {R"(/solver={"scheme": "block", "tolerance": )" + (viscosity > 1e4 ? "1e-9}"s : "1e-11}"s)}));
  SceneRun umfpack(with(scene, {R"(/solver={"scheme": "umfpack"})"}));
  constexpr int steps = Dim == 2 ? 3 : 2;
  block.step(steps);
  umfpack.step(steps);
  CHECK(distance<Dim>(block, umfpack) < 4e-8);  // 1.9e-8 measured
  CHECK(block.world().template resource<SolveReport>().residual <= tolerance);
  CHECK(block.world().template resource<SolveReport>().iterations > 0);
}

TEMPLATE_TEST_CASE_SIG("the block solver gives the steps of UMFPACK where iterations solve for stiff velocities",
                       "[property][long]", ((int Dim), Dim), 2, 3) {
  // Friction of once and seven times the inertia; more than 3000 velocities.
  constexpr double viscosity = Dim == 2 ? 10 : 450;
  constexpr int steps = Dim == 2 ? 2 : 1;  // UMFPACK takes seconds in 3-D
  Json scene = lump_and_drop<Dim>(viscosity);
  scene["grid"]["cells"] = Dim == 2 ? Json({100, 80}) : Json({20, 16, 8});
  scene["particles"].erase(1);
  scene["time"]["step"] = Dim == 2 ? 2e-3 : 5e-3;
  SceneRun block(with(scene, {R"(/solver={"scheme": "block", "tolerance": 1e-10})"}));
  SceneRun umfpack(with(scene, {R"(/solver={"scheme": "umfpack"})"}));
  block.step(steps);
  umfpack.step(steps);
  REQUIRE(Dim * block.world().template column<matrix::Node>().size() > 3000);
  CHECK(distance<Dim>(block, umfpack) < 5e-9);  // 2.5e-9 measured
  const auto& report = block.world().template resource<SolveReport>();
  CHECK(report.residual <= 1e-10);
  CHECK(report.residual > 1e-14);  // UMFPACK would leave less
}

TEMPLATE_TEST_CASE_SIG("the block solver solves the discrete equations", "[property]", ((int Dim), Dim), 2, 3) {
  const double viscosity = GENERATE(0.0, 3.0, 1e2);
  CAPTURE(viscosity);
  SceneRun run(with(lump_and_drop<Dim>(viscosity),
                    {R"(/solver={"scheme": "block", "tolerance": 1e-11})", R"(/quadrature={"scheme": "particles"})",
                     R"(/transfer={"scheme": "tpic", "inertia": "lumped", "spin": "gradient"})"}));
  run.step();
  const auto equations = dense::assemble<Dim>(run);
  const Eigen::VectorXd x = dense::solution<Dim>(run.world());
  REQUIRE(equations.matrix.rows() == x.size());
  // Row by row, each against the sum of the sizes of its terms.
  const Eigen::VectorXd rest = (equations.right_hand_side - equations.matrix * x).cwiseAbs();
  const Eigen::VectorXd size = equations.matrix.cwiseAbs() * x.cwiseAbs() + equations.right_hand_side.cwiseAbs();
  Largest worst;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (size[i] != 0) worst.add(rest[i] / size[i]);
  }
  // GMRES stops anywhere below 1e-11 of all together: 2e-12 measured.
  CHECK(worst.value() < 1e-11);
}

TEST_CASE("the block solver balances the momentum of a shear flow under gravity", "[property]") {
  // Shear leaves nothing in the mass balance, whose terms the weight of the liquid makes large.
  const double nu = GENERATE(0.1, 0.04);
  CAPTURE(nu);
  const Json scene = with(of_equal_order(scene_of_file("poiseuille.json")),
                          {R"(/body_force=["F", -9.81])", "/fluid/viscosity=" + std::to_string(1000 * nu),
                           "/constants/nu=" + std::to_string(nu)});
  SceneRun block(with(scene, {R"(/solver={"scheme": "block", "tolerance": 1e-8})"}));
  SceneRun umfpack(with(scene, {R"(/solver={"scheme": "umfpack"})"}));
  block.step(10);
  umfpack.step(10);
  const double exact = umfpack.world().resource<measure::Energy>().kinetic;
  CHECK(block.world().resource<measure::Energy>().kinetic == Approx(exact).epsilon(1.4e-7));  // 7e-8 measured
}

TEST_CASE("the block solver takes few iterations in a splash", "[property]") {
  SceneRun run(with(scene_of_file("paper/dam_break_tpic.json"),
                    {"/grid/cells=[20, 20]", "/time/step=4e-3", R"(/integrator={"scheme": "midpoint"})",
                     R"(/volume={"scheme": "projection"})", R"(/solver={"scheme": "block"})"}));
  std::int64_t most = 0;
  // The front meets the far wall at 0.3 s; drops rain until 1.2 s.
  for (int k = 0; k < 300; ++k) {
    run.step();
    if (k > 0) most = std::max<std::int64_t>(most, run.world().resource<SolveReport>().iterations);
  }
  CHECK(most <= 8);  // 7 were measured
}

TEST_CASE("a step in which GMRES does not converge is UMFPACK's", "[property]") {
  const Json scene = lump_and_drop<2>(1e5);
  SceneRun block(with(scene, {R"(/solver={"scheme": "block"})"}));
  SceneRun umfpack(with(scene, {R"(/solver={"scheme": "umfpack"})"}));
  block.world().resource<SolverTolerance>().relative = 1e-18;  // a residual that rounding does not allow
  block.step();
  umfpack.step();
  CHECK(block.world().resource<SolveReport>().iterations == 100);
  CHECK(block.world().resource<SolveReport>().residual == umfpack.world().resource<SolveReport>().residual);
  CHECK(distance<2>(block, umfpack) == 0);
}

TEST_CASE("a closed full box has no pressure of its own and the block solver still converges", "[property]") {
  SceneRun run(with(of_equal_order(scene_of_file("taylor_green.json")),
                    {"/grid/cells=[12, 12]", R"(/solver={"scheme": "block"})"}));
  run.step(5);
  CHECK(run.world().resource<SolveReport>().residual <= 1e-8);
  CHECK(run.world().resource<SolveReport>().iterations <= 4);  // 2 were measured
}

TEST_CASE("the block solver gives the steps of UMFPACK around a short periodic axis", "[property]") {
  const int cells = GENERATE(5, 8, 9);
  CAPTURE(cells);
  Json scene = lump_and_drop<2>(3.0);
  scene["walls"] = {{"x", "periodic"}, {"y", "slip"}};
  scene["grid"] = {{"low", {0, 0}}, {"high", {0.1 * cells, 0.8}}, {"cells", {cells, 8}}};
  scene["particles"][0]["shape"]["box"]["high"][0] = 0.3;
  scene["particles"].erase(1);
  SceneRun block(with(scene, {R"(/solver={"scheme": "block", "tolerance": 1e-11})"}));
  SceneRun umfpack(with(scene, {R"(/solver={"scheme": "umfpack"})"}));
  block.step(3);
  umfpack.step(3);
  CHECK(distance<2>(block, umfpack) < 8e-11);  // 4e-11 measured
}

TEST_CASE("the block solver takes few iterations, whatever the resolution", "[property]") {
  const int cells = GENERATE(20, 40, 80);
  CAPTURE(cells);
  SceneRun run(with(scene_of_file("paper/dam_break_tpic.json"),
                    {"/grid/cells=[" + std::to_string(cells) + ", " + std::to_string(cells) + "]",
                     "/time/step=" + std::to_string(0.08 / cells), R"(/integrator={"scheme": "midpoint"})",
                     R"(/solver={"scheme": "block"})"}));
  run.step(30);
  CHECK(run.world().resource<SolveReport>().iterations <= 8);  // 3 to 5 were measured
}

void fill(EnvelopeLu& lu, const Eigen::MatrixXd& a) {
  std::vector<std::uint32_t> first;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    Eigen::Index k = 0;
    while (a(i, k) == 0) ++k;
    first.push_back(static_cast<std::uint32_t>(std::min(i, k)));
  }
  lu.start(first);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      if (a(i, j) == 0) continue;
      lu.at(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) = a(i, j);
    }
  }
}

TEST_CASE("LU within an envelope solves what dense LU solves", "[property]") {
  // A narrow band, a long one, and one as wide as long.
  const auto [rows, half_width] = GENERATE(std::pair(60, 9), std::pair(611, 45), std::pair(150, 149));
  CAPTURE(rows, half_width);
  const Eigen::MatrixXd a = random_band(rows, half_width, 0.7);
  EnvelopeLu lu;
  fill(lu, a);
  REQUIRE(lu.factorize());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(rows, -1, 3);
  Values x = as_values(b);
  lu.solve(x);
  // Twice the last digit was measured.
  CHECK(difference(x, dense::solve(a, b)) < 20 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("LU within an envelope solves where rows reach far", "[property]") {
  // A wide body of water, and a thin long arm.
  Eigen::MatrixXd a = random_band(1600, 4, 0.7);
  a.topLeftCorner(800, 800) += random_band(800, 60, 0.7);
  for (const Eigen::Index row : {300, 451, 452, 470, 790}) {
    a(row, row - 150) = 0.5;
    a(row - 150, row) = -0.25;
  }
  EnvelopeLu lu;
  fill(lu, a);
  REQUIRE(lu.factorize());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(1600, -1, 3);
  Values x = as_values(b);
  lu.solve(x);
  CHECK(difference(x, dense::solve(a, b)) < 2e-15);  // the last digit
}

TEST_CASE("LU within an envelope tells a singular matrix", "[property]") {
  EnvelopeLu lu;
  fill(lu, Eigen::MatrixXd::Constant(2, 2, 1));
  CHECK_FALSE(lu.factorize());
}

TEST_CASE("few particles with many nodes in 3-D are solved without UMFPACK, which has no memory for them",
          "[property]") {
  if (is_address_sanitized()) return;  // three quarters of a minute there
  Json scene = paper(scene_of_file("dam_break_3d.json"));
  scene["solver"] = {{"scheme", "block"}};
  // As wide as it is high, so that the envelope is not narrow.
  scene["particles"] = Json::parse(
      R"([{"shape": {"box": {"low": [0, 0, 0], "high": [0.292, 0.292, 0.292]}}, "per_cell": 1, "arrangement": "jittered"}])");
  SceneRun run(scene);
  run.step(1);
  const auto& report = run.world().resource<SolveReport>();
  CHECK(report.residual > 1e-12);  // GMRES stops at 1e-8, UMFPACK leaves less
  CHECK(report.residual <= 1e-8);
}

TEST_CASE("GMRES reaches its target though products have the errors that it allows", "[property]") {
  const bool exact = GENERATE(true, false);
  constexpr int rows = 60;
  const Eigen::MatrixXd a = random_band(rows, 9, 0.7);
  int products = 0;
  const auto apply = [&](const Values& x, Values& out, double allowed) {
    Eigen::Map<Eigen::VectorXd> product(out.data(), rows);
    product = a * Eigen::Map<const Eigen::VectorXd>(x.data(), rows);
    ++products;
    for (int i = 0; i < rows && !exact; ++i) product[i] += (i * products % 7 < 3 ? 1 : -1) * allowed / std::sqrt(rows);
  };
  const auto precondition = [](const Values& r, Values& out) { out = r; };
  const Values b = as_values(Eigen::VectorXd::LinSpaced(rows, -1, 3));
  const double target = 1e-8 * std::sqrt(dot(b, b));
  Gmres gmres;
  Values x(rows);
  const auto report = gmres.solve(apply, precondition, b, target, 200, Gmres::Start::zero, x);
  CHECK(report.converged);
  const Eigen::VectorXd left =
      Eigen::Map<const Eigen::VectorXd>(b.data(), rows) - a * Eigen::Map<const Eigen::VectorXd>(x.data(), rows);
  CHECK(left.norm() <= 1.5 * target);  // the last product, which tells, may be off by half of it
  CHECK(report.iterations <= 20);      // 10 were measured, with exact ones, too
}

TEST_CASE("sparse Cholesky solves what dense Cholesky solves, again with another pattern", "[property]") {
  SparseCholesky cholesky;
  for (const int rows : {40, 2500}) {  // simplicial and supernodal
    const Eigen::MatrixXd a = random_band(rows, 7, 0);
    cholesky.start(static_cast<std::size_t>(rows));
    for (int i = 0; i < rows; ++i) {
      for (int j = i; j >= std::max(0, i - 7); --j) {
        cholesky.add(static_cast<std::size_t>(i), static_cast<std::size_t>(j), a(i, j));
      }
    }
    REQUIRE(cholesky.factorize());
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows, -1, 3);
    Values got = as_values(a * x);
    cholesky.solve(got);
    CHECK(difference(got, x) < 2e-15);  // the last digit
  }
}

TEST_CASE("sparse Cholesky tells an indefinite matrix", "[property]") {
  SparseCholesky cholesky;
  cholesky.start(2);
  cholesky.add(0, 0, 1);
  cholesky.add(1, 0, 2);
  cholesky.add(1, 1, 1);
  CHECK_FALSE(cholesky.factorize());
}

TEST_CASE("incomplete LU is LU where nothing falls outside of the pattern", "[property]") {
  constexpr int rows = 60;
  const Eigen::MatrixXd a = random_band(rows, 9, 0.7);
  SparseRows matrix;
  for (int i = 0; i < rows; ++i) {
    for (int j = std::max(0, i - 9); j <= std::min(rows - 1, i + 9); ++j) {
      matrix.column.push_back(static_cast<std::uint32_t>(j));
      matrix.value.push_back(a(i, j));
    }
    matrix.begin.push_back(static_cast<std::uint32_t>(matrix.column.size()));
  }
  IncompleteLu lu;
  lu.factorize(matrix);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows, -1, 3);
  Values got = as_values(a * x);
  lu.solve(got);
  CHECK(difference(got, x) < 20 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("incomplete LU is near the matrix, whatever its sign", "[property]") {
  // The five-point matrix of a square with a wind, minus a multiple of one; without a wind the lowest eigenvalue is
  // 4 - 8 cos^2(pi/22) = 0.16.
  const double shift = GENERATE(0.0, 1.0);
  CAPTURE(shift);
  constexpr int side = 10;
  SparseRows matrix;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(side * side, side * side);
  for (int i = 0; i < side * side; ++i) {
    for (const int j : {i - side, i - 1, i, i + 1, i + side}) {
      const bool is_across_an_end = (j == i - 1 && i % side == 0) || (j == i + 1 && j % side == 0);
      if (j < 0 || j >= side * side || is_across_an_end) continue;
      a(i, j) = i == j ? 4 - shift : j < i ? -1.25 : -0.75;
      matrix.column.push_back(static_cast<std::uint32_t>(j));
      matrix.value.push_back(a(i, j));
    }
    matrix.begin.push_back(static_cast<std::uint32_t>(matrix.column.size()));
  }
  IncompleteLu lu;
  lu.factorize(matrix);
  const auto apply = [&](const Values& x, Values& out, double) {
    Eigen::Map<Eigen::VectorXd>(out.data(), a.rows()) = a * Eigen::Map<const Eigen::VectorXd>(x.data(), a.rows());
  };
  const auto precondition = [&](const Values& r, Values& out) {
    out = r;
    lu.solve(out);
  };
  const Eigen::VectorXd x_e = Eigen::VectorXd::LinSpaced(side * side, -1, 3);
  const Values b = as_values(a * x_e);
  Gmres gmres;
  Values x(side * side);
  const auto report = gmres.solve(apply, precondition, b, 1e-10 * std::sqrt(dot(b, b)), 200, Gmres::Start::zero, x);
  CHECK(report.converged);
  CHECK(report.iterations < (shift == 0 ? 25 : 50));  // 15 and 31 were measured
  CHECK(difference(x, x_e) < 3e-10);
}

TEST_CASE("GMRES solves with and without restarts, and says where it stopped", "[property]") {
  const Eigen::MatrixXd a = random_band(200, 30, 2);
  const Eigen::VectorXd x_e = Eigen::VectorXd::LinSpaced(200, -1, 3);
  const Values b = as_values(a * x_e);
  const auto apply = [&](const Values& x, Values& out, double) {
    Eigen::Map<Eigen::VectorXd>(out.data(), 200) = a * Eigen::Map<const Eigen::VectorXd>(x.data(), 200);
  };
  const auto precondition = [](const Values& r, Values& out) { out = r; };
  Gmres gmres;
  Values x(200, 1.0);
  const double norm = std::sqrt(dot(b, b));
  const auto report = gmres.solve(apply, precondition, b, 1e-11 * norm, 2000, Gmres::Start::zero, x);
  CHECK(report.converged);
  CHECK(report.iterations > 0);
  CHECK(report.residual <= 1e-11 * norm);
  CHECK(difference(x, x_e) < 9e-12);  // 4.9e-12 measured
  // From the solution there is nothing left to do; with too few iterations it does not claim success.
  CHECK(gmres.solve(apply, precondition, b, 1e-10 * norm, 2000, Gmres::Start::x, x).iterations == 0);
  Values y(200, 0.0);
  CHECK_FALSE(gmres.solve(apply, precondition, b, 1e-11 * norm, 3, Gmres::Start::zero, y).converged);
}
