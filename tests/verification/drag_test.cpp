/// \file
/// What a stream does to a body: nothing without friction, the paradox of d'Alembert; the same whether the body or the
/// liquid moves, and however long the steps are.

#include "support/extremes.hpp"
#include "support/scene_run.hpp"

#include "components/body.hpp"
#include "components/staggered.hpp"

#include <catch2/catch.hpp>

#include <spdlog/fmt/fmt.h>

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A stream of 1 m/s past a body 1 m wide in a channel of 5 m, or the body through liquid at rest. The air at the
/// outlet has a pressure, or the liquid would tear behind the body.
Json stream(const char* shape, const char* wall, double viscosity, double step, bool body_moves) {
  Json scene = Json::parse(fmt::format(R"json({{"dimension": 2, "constants": {{"X": {}, "u": {}}},
    "grid": {{"low": [0, 0], "high": [10, 5], "cells": [60, 30]}}, "fluid": {{"density": 1, "viscosity": {}}},
    "particles": [{{"shape": {{"where": "1"}}, "per_cell": 2, "velocity": ["u", "0"]}}],
    "bodies": [{{"name": "body", "wall": "{}", "shape": {}}}],
    "openings": [{{"name": "in", "side": "x_low", "inflow": {{"velocity": ["u", "0"]}}}},
                 {{"name": "out", "side": "x_high", "outflow": {{"pressure": 10}}}}],
    "time": {{"end": 9, "step": {}}}}})json",
                                       body_moves ? 6.5 : 3.5, body_moves ? 0 : 1, viscosity, wall, shape, step));
  if (body_moves) scene["bodies"][0]["motion"] = {{"prescribed", {{"velocity", {"-1", "0"}}}}};
  return scene;
}

constexpr const char* cylinder = R"({"ball": {"center": ["X", 2.5], "radius": 0.5}})";
constexpr const char* square = R"({"box": {"low": ["X - 0.5", 2], "high": ["X + 0.5", 3]}})";

/// Drag coefficient, the mean of the force over times.
double drag(const Json& scene, double from, double to) {
  const double step = scene["time"]["step"].get<double>();
  SceneRun run(scene);
  const int before = static_cast<int>(std::lround(from / step));
  const int steps = static_cast<int>(std::lround((to - from) / step));
  run.step(before);
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    run.step();
    sum += measured(run.world(), "body_force_x");
    if (scene["bodies"][0]["wall"] == "no_slip") sum += measured(run.world(), "body_friction_x");
  }
  return 2 * sum / steps;
}

}  // namespace

TEST_CASE("a stream does nothing to a cylinder without friction", "[verification]") {
  // 0.29, 0.27; 0.79, 0.72 without (E126), 1.19, 1.57 of the pressure alone without (E120).
  const auto [body_moves, most] = GENERATE(table<bool, double>({{false, 0.4}, {true, 0.4}}));
  CAPTURE(body_moves);
  CHECK(std::abs(drag(stream(cylinder, "slip", 0, 0.04, body_moves), 0.4, 1.2)) < most);
}

TEST_CASE("drag is the same for a body that moves and one that stands, at any step", "[verification][long]") {
  const bool body_moves = GENERATE(false, true);
  const double step = GENERATE(0.04, 0.01);
  CAPTURE(body_moves, step);
  // Reynolds number 20. 3.60 with 24 cells across, 3.60 to 3.82 with 6: that is what the stream loses, test below. The
  // force without (E126) was 3.62 to 3.77; 3.4 to 5.6 when faces at the wall were set back in every step.
  CHECK(drag(stream(square, "no_slip", 0.05, step, body_moves), 2, 3) == Approx(3.6).epsilon(0.065));
}

TEST_CASE("the force on a body is the momentum that the liquid loses", "[verification]") {
  // A stream along a periodic axis between walls without friction: it loses momentum to the body alone.
  const auto [shape, wall, viscosity, step, off] = GENERATE(table<const char*, const char*, double, double, double>(
      {{R"({"box": {"low": [4.5, 2], "high": [5.5, 3]}})", "slip", 0, 0.04, 0.02},  // 1.10 of it without (E126)
       {R"({"box": {"low": [4.5, 2], "high": [5.5, 3]}})", "slip", 0, 0.01, 0.02},  // 1.22
       {R"({"box": {"low": [4.5, 2], "high": [5.5, 3]}})", "no_slip", 0.05, 0.01, 0.01},
       {R"({"ball": {"center": [5, 2.5], "radius": 0.5}})", "slip", 0, 0.01, 0.05},           // 3.4
       {R"({"ball": {"center": [5, 2.5], "radius": 0.5}})", "no_slip", 0.05, 0.01, 0.01}}));  // 0.90
  CAPTURE(shape, wall, step);
  const std::string scheme = GENERATE("tpic", "flip");
  CAPTURE(scheme);
  Json scene = Json::parse(fmt::format(
      R"json({{"dimension": 2, "grid": {{"low": [0, 0], "high": [10, 5], "cells": [60, 30]}},
    "walls": {{"x": "periodic", "y": "slip"}}, "fluid": {{"density": 1, "viscosity": {}}},
    "particles": [{{"shape": {{"where": "1"}}, "per_cell": 2, "velocity": ["1", "0"]}}],
    "bodies": [{{"name": "body", "wall": "{}", "shape": {}}}], "transfer": {{"scheme": "{}"}},
    "time": {{"end": 9, "step": {}}}}})json",
      viscosity, wall, shape, scheme, step));
  SceneRun run(scene);
  const auto momentum = [&] {
    double sum = 0;
    const auto v = run.world().column<particle::Velocity<2>>();
    for (std::size_t p = 0; p < v.size(); ++p) sum += run.world().column<particle::Mass>()[p] * v[p][0];
    return sum;
  };
  const int steps = static_cast<int>(std::lround(0.4 / step));
  run.step(steps);
  const double before = momentum();
  double impulse = 0;
  for (int k = 0; k < steps; ++k) {
    run.step();
    impulse += step * measured(run.world(), "body_force_x");
    if (viscosity > 0) impulse += step * measured(run.world(), "body_friction_x");
  }
  CHECK(impulse == Approx(before - momentum()).epsilon(scheme == "flip" ? 2 * off : off));
}

TEST_CASE("nothing is damped in liquid that turns like a rigid body in a drum", "[verification]") {
  SceneRun run(Json::parse(R"json({"dimension": 2, "constants": {"w": 2},
    "grid": {"low": [-1.1, -1.1], "high": [1.1, 1.1], "cells": [22, 22]}, "fluid": {"density": 1, "viscosity": 0},
    "particles": [{"shape": {"ball": {"center": [0, 0], "radius": 1}}, "per_cell": 3, "velocity": ["-w*y", "w*x"]}],
    "bodies": [{"name": "drum", "shape": {"invert": {"ball": {"center": [0, 0], "radius": 1}}},
                "motion": {"prescribed": {"velocity": [0, 0], "rotation": {"rate": "w", "center": [0, 0]}}}}],
    "volume": {"scheme": "none"}, "time": {"end": 1, "step": 0.01}})json"));
  run.step(1);
  double most = 0;
  for (const Vec<2>& w : run.world().column<face::Damping<2>>()) most = largest_of(most, w.norm());
  // The velocities of the start, over the places of the middle, lead w^2 dt/2 = 0.02 m/s through the wall. 1.9e-4;
  // 0.011 without (E120).
  CHECK(most < 4e-4);
}
