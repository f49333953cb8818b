/// \file
/// Bodies against exact solutions: water at rest between walls across the grid, water that moves with a body or along
/// one, buoyancy, the mass that an accelerated liquid has.

#include "support/scene_run.hpp"

#include "components/body.hpp"
#include "components/measure.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

double fastest(World& world) { return world.resource<measure::MaxSpeed>().value; }

double column(World& world, const std::string& name) {
  const double* value = world.resource<measure::Columns>().find(name);
  REQUIRE(value != nullptr);
  return *value;
}

/// A tank of 1 m x 1 m, half full, turned by 25 degrees. Under gravity the surface is level.
Json tilted_tank(int cells, int degree) {
  Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [-1, -1], "high": [1, 1]}, "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, -9.81],
    "particles": [{"shape": {"where": "y < 0"}, "per_cell": 2}],
    "bodies": [{"name": "tank", "shape": {"invert": {"box": {"low": [-0.5, -0.5], "high": [0.5, 0.5], "angle": 25}}}}],
    "time": {"end": 1, "step": 0.002}})json");
  scene["grid"]["cells"] = {cells, cells};
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  return scene;
}

/// A channel along x, turned by `angle` degrees, full of liquid that moves along it or with all of it.
Json piston(const std::string& velocity) {
  Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [2, 0.5], "cells": [40, 10]}, "fluid": {"density": 1000, "viscosity": 0},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2}],
    "bodies": [{"name": "piston", "shape": {"box": {"low": [-0.5, -1], "high": [0.0185, 1.5]}}}],
    "time": {"end": 0.5, "step": 0.005}})json");
  scene["bodies"][0]["motion"]["prescribed"]["velocity"] = {velocity, 0};
  return scene;
}

}  // namespace

TEST_CASE("water in a tilted tank rests", "[verification]") {
  const int degree = GENERATE(2, 3);
  CAPTURE(degree);
  SceneRun run(tilted_tank(40, degree));
  run.step(100);
  CHECK(fastest(run.world()) < 0.1);  // 0.03 and 0.05 measured, from the corners of the surface
}

TEST_CASE("the force on a tank is the weight of its water", "[verification]") {
  SceneRun run(tilted_tank(40, 2));
  run.step(100);
  const double weight = 9.81 * total_mass(run.world());
  CHECK(column(run.world(), "tank_force_y") == Approx(-weight).epsilon(5e-3));
  CHECK(std::abs(column(run.world(), "tank_force_x")) < 5e-3 * weight);
}

TEST_CASE("the liquid that is left has the volume that bodies leave", "[verification]") {
  SceneRun run(tilted_tank(40, 2));
  // Half of the tank, but for the samples of the parts that are cut.
  CHECK(total_mass(run.world()) == Approx(500).epsilon(1e-3));
}

TEST_CASE("a piston accelerates the water before it as one body", "[verification]") {
  SceneRun run(piston("t"));
  run.start();
  const double mass = total_mass(run.world());
  run.step(60);
  // At 0.3 s all moves with 0.3 m/s; the force is mass times 1 m/s^2, as exactly as the grid knows where a piston
  // across its faces is: within half a cell of 20.
  CHECK(column(run.world(), "piston_force_x") == Approx(-mass).epsilon(3e-2));
  const auto& energy = run.world().resource<measure::Energy>();
  CHECK(energy.kinetic == Approx(0.5 * mass * 0.09).epsilon(2e-3));
  CHECK(-column(run.world(), "piston_work") == Approx(energy.kinetic).epsilon(2e-2));
}

TEST_CASE("bodies give the same bits on any number of threads", "[verification][threads]") {
  const auto after = [](Execution execution) {
    SceneRun run(tilted_tank(20, 2), execution);
    run.step(20);
    return state(run.world());
  };
  CHECK(after(Execution::graph) == after(Execution::list));
}
