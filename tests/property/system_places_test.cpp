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

/// Of how many pairs of a system and a slot one is tried, another one with every method: so all are, with a third of
/// the methods. Fewer where the sanitizers make each ten times dearer: every system in one slot or two with some
/// method.
const std::size_t stride = is_address_sanitized() ? 31 : 3;

/// Registered systems after slots of the step.
/// \param number  of the method
void try_places(int dimension, std::size_t number, const std::string& method) {
  CAPTURE(dimension, method);
  Scene scene = read(with(drop(dimension), {method}));
  std::size_t pair = number;
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

using Method = std::pair<std::size_t, std::string>;

}  // namespace

TEST_CASE("every system in every slot is refused or runs, whatever the solver and the integrator", "[property]") {
  const auto [number, method] = GENERATE(Method{0, "/solver/scheme=\"block\""}, Method{1, "/solver/scheme=\"umfpack\""},
                                         Method{2, "/integrator/scheme=\"newmark\""});
  try_places(2, number, method);
}

TEST_CASE("every system in every slot is refused or runs, whatever the stabilization", "[property][long]") {
  const auto [number, method] = GENERATE(Method{3, "/stabilization/scheme=\"vms\""},
                                         Method{4, "/stabilization/scheme=\"oss\""}, Method{5, "/fluid/viscosity=0"});
  try_places(2, number, method);
}

TEST_CASE("every system in every slot is refused or runs, whatever the volume correction, and in 3-D",
          "[property][long]") {
  const auto [number, method] = GENERATE(Method{6, "/volume/scheme=\"delta\""}, Method{7, "/volume/scheme=\"none\""});
  try_places(2, number, method);
  try_places(3, number + 1, "/solver/scheme=\"block\"");
}

TEST_CASE("every system in every slot of a conforming step is refused or runs", "[property]") {
  const int dimension = GENERATE(2, 3);
  const std::string method = R"(/discretization={"scheme": "conforming"})";
  const std::size_t samples = dimension == 2 && !is_address_sanitized() ? stride : 1;  // as many are all pairs
  for (std::size_t number = 0; number < samples; ++number) try_places(dimension, number, method);
}
