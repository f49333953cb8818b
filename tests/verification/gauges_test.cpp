/// \file
/// Gauges, meters and patches against levels, flows and pressures that are known.

#include "support/extremes.hpp"
#include "support/scene_run.hpp"
#include "systems/measure/meters.hpp"
#include "systems/scene/scene_checks.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// Water at rest up to a level along the last axis, 1 m wide, cells of 1/16 m.
Json pool(int dimension, double level) {
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<double> gravity(size, 0);
  gravity.back() = -9.81;
  std::vector<double> high(size, 1);
  Json box = {{"low", std::vector<double>(size, 0)}, {"high", high}};
  Json grid = box;
  grid["cells"] = std::vector<int>(size, 16);
  box["high"][size - 1] = level;
  return {{"dimension", dimension},
          {"grid", grid},
          {"fluid", {{"density", 1000}, {"viscosity", 1e-3}}},
          {"body_force", gravity},
          {"particles", {{{"shape", {{"box", box}}}, {"arrangement", "cut"}}}},
          {"time", {{"end", 1}, {"step", 2e-3}}}};
}

std::vector<double> numbers(std::mt19937& random, int count, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> drawn(static_cast<std::size_t>(count));
  for (double& number : drawn) number = uniform(random);
  return drawn;
}

}  // namespace

TEST_CASE("a gauge tells a level between lines of the grid to a thousandth of a cell", "[verification]") {
  const int dimension = GENERATE(2, 3);
  const int seed = GENERATE(1, 2, 3);
  CAPTURE(dimension, seed);
  std::mt19937 random(static_cast<unsigned>(seed));
  const double level = numbers(random, 1, 0.3, 0.7)[0];
  const std::vector<double> at = numbers(random, dimension, 0.02, 0.98);
  std::vector<double> along = numbers(random, dimension, -1, 1);
  along.back() = 1.5;
  Json scene = pool(dimension, level);
  scene["gauges"] = {{{"name", "up"}, {"at", at}},
                     {{"name", "oblique"}, {"at", std::vector<double>(at.size(), 0.5)}, {"along", along}}};
  SceneRun run(scene);
  run.start();
  const int steps = GENERATE(0, 3);
  run.step(steps);
  constexpr double h = 1.0 / 16;
  CHECK(std::abs(measured(run.world(), "up") - (level - at.back())) < 1e-3 * h);
  // Lattice functions are no balls: hundredths of a cell on a line across them.
  const double length = std::hypot(along[0], dimension == 3 ? along[1] : 0, along.back());
  CHECK(std::abs(measured(run.world(), "oblique") - (level - 0.5) * length / along.back()) < 0.05 * h);
}

TEST_CASE("a gauge tells a level on nodes, too, and that of water which slopes", "[verification]") {
  Json scene = of_equal_order(pool(2, 0.4));
  scene["particles"][0] = {{"shape", {{"where", "y < 0.4 + 0.2*(x - 0.5)"}}}, {"per_cell", 8}};
  scene["gauges"] = {{{"name", "left"}, {"at", {0.31, 0}}}, {{"name", "right"}, {"at", {0.66, 0}}}};
  SceneRun run(scene);
  run.start();
  // Particles of h/8 that are in or out.
  CHECK(std::abs(measured(run.world(), "left") - (0.4 - 0.2 * 0.19)) < 2e-3);
  CHECK(std::abs(measured(run.world(), "right") - (0.4 + 0.2 * 0.16)) < 2e-3);
}

TEST_CASE("a gauge ends at bodies and sees neither drops nor what lies behind", "[verification]") {
  Json scene = pool(2, 0.5);
  scene["bodies"] = {{{"name", "step"}, {"shape", {{"box", {{"low", {0.55, 0}}, {"high", {1, 0.23}}}}}}},
                     {{"name", "roof"}, {"shape", {{"box", {{"low", {0, 0.41}}, {"high", {0.3, 0.6}}}}}}},
                     {{"name", "hill"}, {"shape", {{"box", {{"low", {0.8, 0.2}}, {"high", {1, 0.7}}}}}}}};
  scene["particles"].push_back({{"shape", {{"ball", {{"center", {0.7, 0.85}}, {"radius", 0.08}}}}}});
  scene["gauges"] = {{{"name", "step"}, {"at", {0.71, 0.9}}},  {{"name", "roofed"}, {"at", {0.15, 0.1}}},
                     {{"name", "dry"}, {"at", {0.9, 0.95}}},   {{"name", "covered"}, {"at", {0.9, 0.1}}},
                     {{"name", "under"}, {"at", {0.71, 0.3}}}, {{"name", "on"}, {"at", {0.9, 0.7}}}};
  scene["gauges"][0]["name"] = "in_drop";
  SceneRun run(scene);
  run.start();
  const auto height = [&](const char* name) { return measured(run.world(), name); };
  CHECK(height("under") == Approx(0.2).margin(2e-3));
  CHECK(height("roofed") == Approx(0.31).margin(1e-6));
  CHECK(height("dry") == Approx(0.7 - 0.95).margin(1e-6));
  CHECK(height("on") == Approx(0).margin(1e-6));
  CHECK(std::isnan(height("covered")));
  // The surface above it is that of the drop.
  CHECK(height("in_drop") < 0.05);
}

TEST_CASE("the gauge of a standing wave follows linear theory", "[verification]") {
  constexpr double depth = 0.5;
  constexpr double amplitude = 5e-3;
  const double k = std::numbers::pi;
  const double omega = std::sqrt(9.81 * k * std::tanh(k * depth));
  Json scene = pool(2, depth);
  scene["fluid"]["viscosity"] = 0;
  scene["particles"][0] = {{"shape", {{"distance", "y - 0.5 - 0.005*cos(pi*x)"}}}, {"arrangement", "cut"}};
  scene["grid"]["cells"] = {32, 32};
  scene["gauges"] = {{{"name", "wall"}, {"at", {0, depth}}},
                     {{"name", "quarter"}, {"at", {0.27, depth}}},
                     {{"name", "node"}, {"at", {0.5, depth}}}};
  SceneRun run(scene);
  run.start();
  Largest wall;
  Largest quarter;
  Largest node;
  // A period and a half.
  for (int step = 1; step <= 430; ++step) {
    run.step();
    const double wave = amplitude * std::cos(omega * 2e-3 * step);
    wall.add(std::abs(measured(run.world(), "wall") - wave));
    quarter.add(std::abs(measured(run.world(), "quarter") - wave * std::cos(k * 0.27)));
    node.add(std::abs(measured(run.world(), "node")));
  }
  CHECK(wall.value() < 0.1 * amplitude);
  CHECK(quarter.value() < 0.1 * amplitude);
  CHECK(node.value() < 0.1 * amplitude);
}

TEST_CASE("a meter counts all that openings let in and out", "[verification]") {
  Json scene = Json::parse(R"json({"dimension": 2, "grid": {"low": [0, 0], "high": [2, 1], "cells": [32, 16]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [2, 0.3]}}, "velocity": [0.5, 0]}],
    "openings": [{"name": "in", "side": "x_low", "where": "y < 0.3", "inflow": {"velocity": ["0.5", "0"]}},
                 {"name": "out", "side": "x_high", "outflow": {"level": 0.3}}],
    "meters": [{"name": "entry", "plane": {"point": [0.02, 0.5], "normal": [3, 0]}},
               {"name": "middle", "plane": {"point": [1, 0.2], "normal": [1, 0]}},
               {"name": "exit", "plane": {"point": [1.98, 0], "normal": [-1, 0]}},
               {"name": "above", "plane": {"point": [1, 0], "normal": [1, 0]},
                "within": {"half_space": {"point": [0, 0.15], "normal": [0, -1]}}},
               {"name": "slit", "plane": {"point": [1, 0], "normal": [1, 0]},
                "within": {"box": {"low": [0.999, 0], "high": [1.001, 1]}}}],
    "time": {"end": 2, "step": 4e-3}})json");
  SceneRun run(scene);
  run.start();
  CHECK(std::isnan(measured(run.world(), "middle")));
  const auto volume_between = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < run.world().rows<Particles>(); ++p) {
      const double x = run.world().column<particle::Position<2>>()[p][0];
      if (x > 0.02 && x < 1) sum += run.world().column<particle::Volume>()[p];
    }
    return sum;
  };
  const double before = volume_between();
  run.step(500);
  const auto of = [&](const char* name) { return measured(run.world(), name); };
  // Particles of 6.25e-2 m in cells of nine: what stands between a meter and the side is less than a row of them.
  const double row = 0.3 * 0.0625 / 3;
  CHECK(std::abs(of("entry_volume") - of("in_mass_in") / 1000) < row);
  CHECK(std::abs(of("exit_volume") - of("out_mass_in") / 1000) < row);
  CHECK(std::abs(of("entry_volume") - of("middle_volume") - (volume_between() - before)) < row);
  CHECK(of("above_volume") / of("middle_volume") == Approx(0.5).margin(0.05));
  CHECK(of("slit_volume") == Approx(of("middle_volume")).epsilon(1e-12));
  CHECK(of("middle") == Approx(0.15).margin(0.01));
}

TEST_CASE("a meter counts every particle once, through a periodic end as well", "[verification]") {
  const double plane = GENERATE(0.03, 0.5, 0.97);
  CAPTURE(plane);
  Json scene = pool(2, 1);
  scene["walls"] = {{"x", "periodic"}, {"y", "slip"}};
  scene.erase("body_force");
  scene["particles"][0]["velocity"] = {2, 0};
  scene["meters"] = {{{"name", "Q"}, {"plane", {{"point", {plane, 0}}, {"normal", {-1, 0}}}}}};
  SceneRun run(scene);
  run.start();
  run.step(250);
  // All of the liquid once around.
  CHECK(measured(run.world(), "Q_volume") == Approx(-1).epsilon(1e-9));
}

TEST_CASE("patches of a body under water have its pressure, and their forces make up its own", "[verification]") {
  const int dimension = GENERATE(2, 3);
  Json scene = pool(dimension, 0.8);
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<double> low(size, 0.31);
  std::vector<double> high(size, 0.67);
  low.back() = 0.23;
  high.back() = 0.54;
  std::vector<double> under_low(size, 0);
  std::vector<double> under_high(size, 1);
  under_high.back() = 0.25;
  std::vector<double> side_low = low;
  std::vector<double> side_high = high;
  side_low[0] = 0.6699;
  side_high[0] = 0.68;
  scene["bodies"] = {{{"name", "block"}, {"shape", {{"box", {{"low", low}, {"high", high}}}}}}};
  scene["patches"] = {
      {{"name", "all"}, {"body", "block"}},
      {{"name", "bottom"}, {"body", "block"}, {"within", {{"box", {{"low", under_low}, {"high", under_high}}}}}},
      {{"name", "side"}, {"body", "block"}, {"within", {{"box", {{"low", side_low}, {"high", side_high}}}}}}};
  SceneRun run(scene);
  run.start();
  run.step(2);
  const auto of = [&](const std::string& name) { return measured(run.world(), name); };
  const std::string up = dimension == 2 ? "_force_y" : "_force_z";
  const double volume = std::pow(0.36, dimension - 1) * 0.31;
  CHECK(of("all" + up) == Approx(9810 * volume).epsilon(0.02));
  CHECK(of("all" + up) == Approx(of("block" + up)).epsilon(0.02));
  CHECK(std::abs(of("all_force_x")) < 0.01 * 9810 * volume);
  CHECK(of("side_pressure") == Approx(9810 * (0.8 - 0.385)).epsilon(0.01));
  CHECK(of("side_force_x") == Approx(-9810 * (0.8 - 0.385) * 0.31 * std::pow(0.36, dimension - 2)).epsilon(0.01));
  CHECK(std::abs(of("side" + up)) < 1e-9 * 9810 * volume);
  CHECK(of("bottom_pressure") > 9810 * 0.55);
  CHECK(of("bottom_pressure") < 9810 * 0.58);
}

TEST_CASE("a patch in the air feels nothing, and a gate of a fifth of a cell only its wet side", "[verification]") {
  constexpr double level = 0.45;
  Json scene = pool(2, level);
  scene["particles"][0]["shape"]["box"]["high"] = {0.5, level};
  scene["bodies"] = {{{"name", "gate"}, {"shape", {{"box", {{"low", {0.5, -0.1}}, {"high", {0.5125, 1.1}}}}}}}};
  scene["patches"] = {
      {{"name", "wet"}, {"body", "gate"}, {"within", {{"half_space", {{"point", {0.505, 0}}, {"normal", {1, 0}}}}}}},
      {{"name", "dry"}, {"body", "gate"}, {"within", {{"half_space", {{"point", {0.508, 0}}, {"normal", {-1, 0}}}}}}},
      {{"name", "top"}, {"body", "gate"}, {"within", {{"box", {{"low", {0.4, 0.7}}, {"high", {0.6, 0.9}}}}}}}};
  SceneRun run(scene);
  run.start();
  run.step(2);
  CHECK(measured(run.world(), "wet_force_x") == Approx(9810 * level * level / 2).epsilon(0.03));
  CHECK(measured(run.world(), "dry_force_x") == 0);
  CHECK(measured(run.world(), "top_pressure") == 0);
}

TEST_CASE("columns of the history that things bring are those that names are checked for", "[verification]") {
  const int dimension = GENERATE(2, 3);
  Json scene = pool(dimension, 0.6);
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<double> low(size, 0.25);
  std::vector<double> high(size, 0.5);
  std::vector<double> middle(size, 0.6);
  std::vector<double> normal(size, 0);
  normal[0] = 1;
  scene["fluid"]["viscosity"] = 1;
  scene["bodies"] = {{{"name", "b"}, {"shape", {{"box", {{"low", low}, {"high", high}}}}}, {"wall", "no_slip"}}};
  scene["openings"] = {{{"name", "o"}, {"side", "x_high"}, {"outflow", {{"level", 0.6}}}}};
  scene["probes"] = {{{"name", "p"}, {"at", middle}}};
  scene["gauges"] = {{{"name", "g"}, {"at", middle}}};
  scene["meters"] = {{{"name", "m"}, {"plane", {{"point", middle}, {"normal", normal}}}}};
  scene["patches"] = {{{"name", "q"}, {"body", "b"}}};
  const std::map<std::string, std::string> things{{"b", "body"},  {"o", "opening"}, {"p", "probe"},
                                                  {"g", "gauge"}, {"m", "meter"},   {"q", "patch"}};
  SceneRun run(scene);
  run.step();
  std::set<std::string> checked{"particles", "energy_balance"};  // of openings
  for (const auto& [name, thing] : things) {
    for (const std::string& column : columns_of_thing(name, thing, dimension)) checked.insert(column);
  }
  std::set<std::string> brought;
  for (const auto& column : run.world().resource<measure::Columns>().columns) brought.insert(column.name);
  CHECK(brought == checked);
}
