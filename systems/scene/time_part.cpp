#include "components/step.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene.hpp"
#include "systems/scene/time_counts.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Least error for the time, whatever the grid: below it steps cost more than they gain, above it less is gained than a
/// coarser grid would (scenes/RESULTS.md, frontier).
constexpr double recommended_cfl = 1;

void read_step(Input& input, TimeScene& time) {
  time.step = input.optional_number("step", {.unit = "s", .doc = "length of a step (instead of cfl)", .above = 0});
}

void read_cfl(Input& input, TimeScene& time) {
  time.cfl = input.number("cfl", {.doc = "cells that the fastest particle or body crosses in a step (instead of step)",
                                  .fallback = recommended_cfl,
                                  .above = 0});
  time.max_step = input.optional_number("max_step", {.unit = "s", .doc = "longest step (with cfl)", .above = 0});
}

TimeScene read_time(Input& input) {
  TimeScene time;
  time.end = input.number("end", {.unit = "s", .doc = "end of the run", .above = 0});
  if (input.has("step") && !input.describing()) {
    input.one_of("a fixed step, or one from the CFL number",
                 {{"step", [&](Input& in) { read_step(in, time); }}, {"cfl", [&](Input& in) { read_cfl(in, time); }}});
    return time;
  }
  read_step(input, time);
  read_cfl(input, time);
  return time;
}

Contribution read_time_part(Input& input, Scene& scene) {
  input.object("time", "how far and how fast", Input::Presence::required, [&](Input& time) {
    scene.time = read_time(time);
    check_steps(time, scene.time);
  });
  return [](const Scene& of, Recipe& recipe) {
    // A step that was chosen by its CFL number may come out faster than the particles were before it.
    LargestMove largest;
    largest.cells = std::max(largest.cells, 2 * of.time.cfl);
    recipe.constant(largest);
  };
}

}  // namespace

void add_time(SystemRegistry& registry) { registry.add(Part{"time", "how far and how fast", read_time_part}); }

}  // namespace minamo
