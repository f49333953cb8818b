#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scenes.hpp"

#include "components/measure.hpp"
#include "systems/equal_order/limit_shift.hpp"

using namespace minamo;
using minamo::scene_run::of_equal_order;
using minamo::scene_run::SceneRun;

namespace {

/// Water thrown together at random in the lower half of a box, without gravity: it overlaps here and gapes there.
Json heap(const std::string& volume) {
  Json scene = Json::parse(R"({
    "dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [16, 16]},
    "fluid": {"density": 1000, "viscosity": 1},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2, "arrangement": "jittered",
                   "seed": 7}],
    "integrator": {"scheme": "midpoint"},
    "time": {"end": 1, "step": 0.002}
  })");
  scene["volume"] = {{"scheme", volume}};
  return scene;
}

double overlap_after(const std::string& volume, int steps) {
  SceneRun run(heap(volume));
  run.step(steps);
  return run.world().resource<measure::Overlap>().value;
}

}  // namespace

TEST_CASE("without a correction overlap stays", "[property]") {
  SceneRun run(heap("none"));
  run.start();
  const double before = run.world().resource<measure::Overlap>().value;
  run.step(50);
  CHECK(run.world().resource<measure::Overlap>().value == Approx(before).epsilon(1e-14));
}

TEST_CASE("a volume correction takes overlap away", "[property]") {
  const std::string volume = GENERATE("delta", "projection");
  CAPTURE(volume);
  CHECK(overlap_after(volume, 100) < 0.5 * overlap_after("none", 1));
}

TEST_CASE("a volume correction changes no velocity", "[property]") {
  const std::string volume = GENERATE("delta", "projection");
  CAPTURE(volume);
  SceneRun run(heap(volume));
  run.step(20);
  // Nothing drives the water, so the velocities stay those of the start, 0.
  CHECK(run.world().resource<measure::MaxSpeed>().value < 1e-15);
}

TEST_CASE("a volume correction leaves a lone drop alone", "[property]") {
  const std::string volume = GENERATE("delta", "projection");
  CAPTURE(volume);
  Json scene = heap(volume);
  scene["particles"] = Json::parse(R"([{"shape": {"box": {"low": [0.3, 0.3], "high": [0.33, 0.33]}}, "per_cell": 2}])");
  SceneRun run(scene);
  run.start();
  const auto before = scene_run::by_id<particle::Position<2>>(run.world());
  REQUIRE_FALSE(before.empty());
  run.step(10);
  const auto after = scene_run::by_id<particle::Position<2>>(run.world());
  Largest moved;
  for (std::size_t p = 0; p < before.size(); ++p) moved.add((after[p] - before[p]).norm());
  CHECK(moved.value() < 1e-15);  // it fills no node, so that there is no excess
}

TEST_CASE("particles on the seam of a periodic axis overlap with nothing", "[property]") {
  // One per cell: every particle lies half-way between two nodes, those of a column on the seam.
  const int per_cell = GENERATE(1, 3);
  CAPTURE(per_cell);
  Json scene = heap("none");
  scene["walls"] = {{"x", "periodic"}, {"y", "slip"}};
  scene["particles"] = Json::parse(R"([{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}}])");
  scene["particles"][0]["per_cell"] = per_cell;
  SceneRun run(scene);
  run.start();
  // Rounding; 5 to 15 with a weight taken one box away.
  CHECK(run.world().resource<measure::Overlap>().value < 2e-15);
}

namespace {

/// A dam break that squeezes the water at the wall which it hits.
Json impact() {
  return of_equal_order(Json::parse(R"({
    "dimension": 2,
    "grid": {"low": [0, 0], "high": [0.584, 0.584], "cells": [16, 16]},
    "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.146, 0.292]}}, "per_cell": 2}],
    "time": {"end": 1, "step": 0.004}
  })"));
}

double energy_after_a_step(SceneRun& run) {
  run.step();
  const auto& energy = run.world().resource<measure::Energy>();
  return energy.kinetic + *energy.potential;
}

/// What is left of a shift of all nodes by `height`, when the step lost `share` of what that lifts.
double left_of_shift(double height, double share) {
  SceneRun run(impact());
  run.step(3);
  World& world = run.world();
  const double weight = 1000 * 0.146 * 0.292 * 9.81;
  auto& before = world.resource<EnergyBefore>();
  const auto m_i = world.column<node::Mass>();
  const auto u_i = world.column<node::Displacement<2>>();
  double fallen = 0;
  for (std::size_t i = 0; i < m_i.size(); ++i) fallen -= m_i[i] * 9.81 * u_i[i][1];
  before.kinetic = world.resource<measure::Energy>().kinetic - fallen + share * weight * std::abs(height);
  for (Vec<2>& d : world.column<node::Shift<2>>()) d = {0, height};
  kernels::run<LimitShift<2>>(world);
  return world.column<node::Shift<2>>().front()[1] / height;
}

}  // namespace

TEST_CASE("the projection of the volume feeds no energy", "[property]") {
  SceneRun run(impact());
  const double start = energy_after_a_step(run);
  Smallest lowest;
  lowest.add(start);
  Largest rise;
  for (int k = 1; k < 120; ++k) {
    const double energy = energy_after_a_step(run);
    rise.add(energy - lowest.value());
    lowest.add(energy);
  }
  CHECK(lowest.value() < 0.9 * start);  // the water has hit the wall
  // Only rounding was measured, 3e-16; without (E69) 1.15e-3. Other roundings lead to another splash, so that there is
  // room for what the transfer between particles and nodes may do there.
  CHECK(rise.value() < 1e-6 * start);
}

TEST_CASE("a shift lifts no more than the step has lost", "[property]") {
  CHECK(left_of_shift(1e-3, 0.5) == Approx(0.5).epsilon(4e-15));  // rounding: every particle is on nodes of the step
  CHECK(left_of_shift(1e-3, 2) == 1);
  CHECK(left_of_shift(1e-3, -1) == 0);   // the step has gained energy
  CHECK(left_of_shift(-1e-3, -1) == 1);  // what sinks gives energy
}
