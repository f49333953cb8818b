#include "support/scene_run.hpp"

#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/warnings.hpp"
#include "systems/bodies/particles/watch_bodies.hpp"
#include "systems/measure/watch_volume.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A tank of 1 m, half full of water at rest, cells of 0.1 m; in 3-D 0.3 m deep.
Json tank(int dimension, const std::string& discretization) {
  Json scene = Json::parse(R"({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2}],
    "time": {"end": 1, "step": 1e-3}})");
  if (dimension == 3) {
    scene["dimension"] = 3;
    scene["grid"] = Json::parse(R"({"low": [0, 0, 0], "high": [1, 1, 0.3], "cells": [10, 10, 3]})");
    scene["body_force"] = Json::parse("[0, -9.81, 0]");
    scene["particles"][0]["shape"] = Json::parse(R"({"box": {"low": [0, 0, 0], "high": [1, 0.5, 0.3]}})");
  }
  scene["discretization"]["scheme"] = discretization;
  return scene;
}

template <int Dim>
std::vector<std::string> told(World& world) {
  make_system<WatchVolume<Dim>>("watch_volume").run(world);
  return world.resource<Warnings>().texts();
}

/// Moves all particles down, to that share of their height.
template <int Dim>
void squeeze(World& world, double share) {
  for (Vec<Dim>& x : world.column<particle::Position<Dim>>()) x[1] *= share;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("liquid at rest that lies lower than its volume can is told, whatever the overlap", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const std::string discretization = GENERATE("conforming", "equal_order");
  CAPTURE(discretization);
  SceneRun run(tank(Dim, discretization));
  run.step(1);
  CHECK(told<Dim>(run.world()).empty());
  squeeze<Dim>(run.world(), 0.99);
  CHECK(told<Dim>(run.world()).empty());
  squeeze<Dim>(run.world(), 0.95);
  const auto found = told<Dim>(run.world());
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Catch::Contains("the middle of the liquid lies 0.01"));  // 6 % of 0.25 m
}

TEST_CASE("liquid that has been lifted has lost nothing", "[property]") {
  SceneRun run(tank(2, "conforming"));
  run.step(1);
  for (Vec<2>& x : run.world().column<particle::Position<2>>()) x[1] = 0.5 + 0.5 * x[1];
  CHECK(told<2>(run.world()).empty());
}

TEST_CASE("an overlap is told from a twentieth on, and what to change from a fifth on", "[property]") {
  SceneRun run(tank(2, "equal_order"));
  run.step(1);
  run.world().resource<StepTotals>().overlap_max = 0.049;
  CHECK(told<2>(run.world()).empty());
  run.world().resource<StepTotals>().overlap_max = 0.051;
  const auto first = told<2>(run.world());
  REQUIRE(first.size() == 1);
  CHECK_THAT(first[0], Catch::Contains("5.1 % of the liquid lies where there is no room for it"));
  run.world().resource<StepTotals>().overlap_max = 0.21;
  const auto second = told<2>(run.world());
  REQUIRE(second.size() == 2);  // the first is not told again
  CHECK_THAT(second[1], Catch::Contains("to change: a shorter step") && Catch::Contains("conforming"));
}

TEST_CASE("particles outside of the grid are told", "[property]") {
  SceneRun run(tank(2, "conforming"));
  run.step(1);
  run.world().column<particle::Position<2>>()[3] = {-0.01, 0.2};
  const auto found = told<2>(run.world());
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Catch::Contains("1 particles lie outside of the grid"));
}

TEST_CASE("particles in a body are told with the body and the place", "[property]") {
  Json scene = tank(2, "conforming");
  scene["bodies"] = Json::parse(R"([{"name": "post", "shape": {"box": {"low": [0.42, 0], "high": [0.58, 0.8]}}}])");
  SceneRun run(scene);
  run.step(1);
  CHECK(run.world().resource<Warnings>().texts().empty());
  run.world().column<particle::Position<2>>()[3] = {0.45, 0.2};
  make_system<WatchBodies<2>>("watch_bodies").run(run.world());
  const auto found = run.world().resource<Warnings>().texts();
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Catch::Contains("1 particles lie in bodies") &&
                           Catch::Contains("0.03 m deep in \"post\" at x = 0.45, y = 0.2"));
}
