#include "components/step.hpp"
#include "systems/parts.hpp"
#include "systems/setup/scene.hpp"

#include <algorithm>

namespace minamo {

namespace {

TimeScene read_time(Input& input) {
  TimeScene time;
  time.end = input.number("end", {.unit = "s", .doc = "end of the run", .above = 0});
  input.one_of(
      "a fixed step, or one from the CFL number",
      {{"step",
        [&](Input& in) { time.step = in.number("step", {.unit = "s", .doc = "length of a step", .above = 0}); }},
       {"cfl", [&](Input& in) {
          time.cfl = in.number("cfl", {.doc = "cells that the fastest particle crosses in a step", .above = 0});
          time.max_step = in.optional_number("max_step", {.unit = "s", .doc = "longest step", .above = 0});
        }}});
  return time;
}

Contribution read_time_part(Input& input, Scene& scene) {
  input.object("time", "how far and how fast", Input::Presence::required,
               [&](Input& time) { scene.time = read_time(time); });
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
