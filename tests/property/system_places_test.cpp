#include "support/build.hpp"
#include "support/scene_run.hpp"

#include "engine/run/step_control.hpp"
#include "engine/schedule/schedule.hpp"
#include "systems/seeding/seed.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A drop that falls on the floor; it has a surface, walls and light nodes.
Json drop(int dimension) {
  return Json::parse(dimension == 2 ? R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [6, 6]},
    "fluid": {"density": 1000, "viscosity": 1}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0.25, 0], "high": [0.75, 0.5]}}, "velocity": [1, 0]}],
    "time": {"end": 1, "step": 0.01}})json"
                                    : R"json({
    "dimension": 3, "grid": {"low": [0, 0, 0], "high": [1, 1, 1], "cells": [4, 4, 4]},
    "fluid": {"density": 1000, "viscosity": 1}, "body_force": [0, 0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0, 0], "high": [0.5, 0.5, 0.5]}}, "velocity": [1, 0, 0]}],
    "time": {"end": 1, "step": 0.01}})json");
}

/// The lists of a run, as the program makes and runs them. \return whether the schedule lets them run
bool runs(const Scene& scene) {
  const Pipeline pipeline = make_pipeline(scene);
  World world;
  seed_world(scene, "drop.json", world);
  std::optional<Schedule> start;
  std::optional<Schedule> step;
  try {
    start.emplace(pipeline.start, world);
    step.emplace(pipeline.step, world);
  } catch (const ScheduleError& refused) {
    CHECK(std::string(refused.what()).find("system \"") == 0);
    return false;
  }
  Clock& clock = world.resource<Clock>();
  clock.step = *scene.time.step;
  try {
    start->run();
    clock.end_of_step = clock.step;
    step->run();
  } catch (const std::exception& failure) {
    CHECK_FALSE(std::string(failure.what()).empty());  // a step that a system in a strange place spoils has a reason
  }
  return true;
}

/// Of how many pairs one is tried: all of them, but a sample where the sanitizers make each ten times dearer: every
/// system in one slot or two, every slot with one system in eleven.
const std::size_t stride = is_address_sanitized() ? 11 : 1;

/// Every registered system after every slot of the step.
void try_all_places(int dimension, const std::string& method) {
  CAPTURE(dimension, method);
  Scene scene = read(with(drop(dimension), {method}));
  std::size_t pair = 0;
  std::size_t refused = 0;
  std::size_t run = 0;
  for (const std::string& name : registry().names()) {
    for (const Slot& slot : slots()) {
      if (pair++ % stride != 0) continue;
      INFO(name << " after " << slot.name);
      scene.systems = {{registry().make(name, dimension), std::string(slot.name)}};
      ++(runs(scene) ? run : refused);
    }
  }
  CHECK(refused > 100 / stride);
  CHECK(run > 100 / stride);
}

}  // namespace

TEST_CASE("every system in every slot is refused or runs, whatever the solver and the integrator", "[property]") {
  try_all_places(2,
                 GENERATE("/solver/scheme=\"block\"", "/solver/scheme=\"umfpack\"", "/integrator/scheme=\"newmark\""));
}

TEST_CASE("every system in every slot is refused or runs, whatever the stabilization", "[property][long]") {
  try_all_places(2, GENERATE("/stabilization/scheme=\"vms\"", "/stabilization/scheme=\"oss\"", "/fluid/viscosity=0"));
}

TEST_CASE("every system in every slot is refused or runs, whatever the volume correction, and in 3-D",
          "[property][long]") {
  try_all_places(2, GENERATE("/volume/scheme=\"delta\"", "/volume/scheme=\"none\""));
  try_all_places(3, "/solver/scheme=\"block\"");
}

TEST_CASE("every system in every slot of a conforming step is refused or runs", "[property]") {
  try_all_places(GENERATE(2, 3), R"(/discretization={"scheme": "conforming"})");
}
