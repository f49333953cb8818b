#include "support/scenes.hpp"

#include "components/measure.hpp"

using namespace minamo;
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
  CHECK(run.world().resource<measure::Overlap>().value == Approx(before).epsilon(0.01));
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
  // Nothing drives the water, so the velocities stay those of the start but for rounding.
  CHECK(run.world().resource<measure::MaxSpeed>().value < 1e-12);
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
  double moved = 0;
  for (std::size_t p = 0; p < before.size(); ++p) moved = std::max(moved, (after[p] - before[p]).norm());
  CHECK(moved < 1e-12);  // it fills no node, so that there is no excess
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
  // At the surface, one particle per cell fills a node by up to 1/64 too much; 5 to 15 with a weight taken one box
  // away.
  CHECK(run.world().resource<measure::Overlap>().value < 0.02);
}
