#include "support/extremes.hpp"
#include "support/scene_run.hpp"

#include "components/staggered.hpp"
#include "engine/run/linear_solver.hpp"
#include "systems/grid/splines.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace minamo;
using namespace minamo::scene_run;

// Compiled together with other tests, whose helpers have the same names.
namespace conforming_umfpack_test {
namespace {

/// Scattered liquid with a surface, in a box with sides of all kinds.
Json scattered(int dimension, int degree, double viscosity) {
  Json scene = Json::parse(dimension == 2 ? R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 0.7], "cells": [10, 7]},
    "walls": {"x": ["slip", "no_slip"], "y": [{"slip_length": 0.02}, "slip"]}, "body_force": [1, -9.81],
    "particles": [{"shape": {"where": "y < 0.32 + 0.1*sin(9*x)"}, "per_cell": 3, "arrangement": "jittered", "seed": 3,
                   "velocity": ["0.3*sin(5*y)", "-0.5*x"]}],
    "time": {"end": 1, "step": 5e-3}})json"
                                          : R"json({
    "dimension": 3, "grid": {"low": [0, 0, 0], "high": [0.6, 0.5, 0.5], "cells": [6, 5, 5]},
    "walls": {"x": "periodic", "y": [{"slip_length": 0.02}, "slip"], "z": ["no_slip", "slip"]},
    "body_force": [1, -9.81, 0.5],
    "particles": [{"shape": {"where": "y < 0.22 + 0.1*sin(9*x) + 0.2*z"}, "arrangement": "jittered", "seed": 3,
                   "velocity": ["0.3*sin(5*y)", "-0.5*x", "z"]}],
    "time": {"end": 1, "step": 5e-3}})json");
  scene["fluid"] = {{"density", 1000}, {"viscosity", viscosity}};
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  scene["volume"] = {{"scheme", "projection"}};
  scene["transfer"] = {{"scheme", "tpic"}};
  return scene;
}

/// A box full of liquid, where nothing but a rule fixes the level of the pressure.
Json closed(double viscosity) {
  Json scene = scattered(2, 2, viscosity);
  scene["particles"][0]["shape"] = {{"box", {{"low", {0, 0}}, {"high", {1, 0.7}}}}};
  scene["particles"][0].erase("arrangement");
  scene["particles"][0].erase("seed");
  scene["particles"][0]["velocity"] = {"0.3*sin(5*y)", "-0.5*sin(3*x)"};
  return scene;
}

Json around(double viscosity) {
  Json scene = closed(viscosity);
  scene["walls"] = {{"x", "periodic"}, {"y", "periodic"}};
  return scene;
}

Json solved_by(Json scene, const Json& solver) {
  scene["solver"] = solver;
  return scene;
}
const Json whole = {{"scheme", "umfpack"}};
const Json usual = {{"scheme", "block"}, {"tolerance", 1e-13}};

/// The largest difference of a column, relative to its largest entry and to what counts as one.
template <class C>
double difference(World& a, World& b, double size = 0) {
  const auto x = a.column<C>();
  const auto y = b.column<C>();
  REQUIRE(x.size() == y.size());
  double off = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if constexpr (std::is_same_v<typename C::value_type, double>) {
      size = largest_of(size, std::abs(y[i]));
      off = largest_of(off, std::abs(x[i] - y[i]));
    } else {
      size = largest_of(size, y[i].norm());
      off = largest_of(off, (x[i] - y[i]).norm());
    }
  }
  return size == 0 ? off : off / size;
}

template <int Dim>
void check_step(const Json& scene) {
  SceneRun reference(solved_by(scene, whole));
  SceneRun run(solved_by(scene, usual));
  reference.step();
  run.step();
  World& a = run.world();
  World& b = reference.world();
  CHECK(difference<face::BalanceVelocity<Dim>>(a, b) <= 1e-9);
  CHECK(difference<face::Damping<Dim>>(a, b, 1e-3) <= 1e-9);
  CHECK(difference<face::Shift<Dim>>(a, b, 1e-3) <= 1e-9);
  CHECK(difference<particle::Position<Dim>>(a, b) <= 1e-9);
  CHECK(difference<particle::Velocity<Dim>>(a, b) <= 1e-9);
  CHECK(difference<multiplier::Force>(a, b) <= 1e-9);
  CHECK(b.resource<SolveReport>().residual <= 1e-10);
  CHECK(b.resource<SolveReport>().iterations == 0);
  CHECK(b.resource<SolveReport>().active == static_cast<std::int64_t>(b.rows<Unknowns>()));
}

bool has(const Json& scene, const std::string& system) {
  const auto names = step_names(scene);
  return std::find(names.begin(), names.end(), system) != names.end();
}

}  // namespace

// Without viscosity, rubbed at the start of the step, and with friction in the balances.

TEST_CASE("UMFPACK on all equations makes the step that the multipliers' solver makes", "[property]") {
  const double viscosity = GENERATE(0.0, 0.05, 10.0, 1e4);
  CAPTURE(viscosity);
  SECTION("in 2-D, degree 2") { check_step<2>(scattered(2, 2, viscosity)); }
  SECTION("in 2-D, degree 3") { check_step<2>(scattered(2, 3, viscosity)); }
  SECTION("in 3-D") { check_step<3>(scattered(3, 2, viscosity)); }
  SECTION("in a closed box") { check_step<2>(closed(viscosity)); }
  SECTION("all around") { check_step<2>(around(viscosity)); }
}

TEST_CASE("the solver that a scene names solves its faces", "[property]") {
  const Json thick = solved_by(scattered(2, 2, 10), whole);
  CHECK(has(thick, "solve_faces_umfpack"));
  CHECK(has(thick, "solve_face_friction_umfpack"));
  CHECK_FALSE(has(thick, "solve_multipliers"));
  CHECK_FALSE(has(thick, "solve_friction"));
  const Json thin = solved_by(scattered(2, 2, 0.05), whole);
  CHECK(has(thin, "rub_faces"));
  CHECK_FALSE(has(thin, "solve_face_friction_umfpack"));
  CHECK(has(solved_by(thick, usual), "solve_friction"));
  CHECK_FALSE(has(solved_by(thick, usual), "solve_faces_umfpack"));
}

TEST_CASE("the tolerance of the solver reaches that of the faces", "[property]") {
  const auto report = [](const Json& scene, double tolerance) {
    SceneRun run(solved_by(scene, {{"scheme", "block"}, {"tolerance", tolerance}}));
    run.step();
    return run.world().resource<SolveReport>();
  };
  // Friction, and multigrid on more unknowns than are factorized.
  Json large = scattered(3, 2, 0);
  large["grid"]["cells"] = {18, 15, 15};
  for (const Json& scene : {scattered(2, 2, 1e3), large}) {
    const SolveReport loose = report(scene, 1e-4);
    const SolveReport tight = report(scene, 1e-10);
    CHECK(loose.residual <= 1e-4);
    CHECK(tight.residual <= 1e-10);
    CHECK(tight.iterations > loose.iterations);
  }
}

}  // namespace conforming_umfpack_test
