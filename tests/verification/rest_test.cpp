/// \file
/// Water at rest rests, whatever the angle of gravity to the grid, the height of its surface between grid lines, and
/// the place of bodies.

#include "support/extremes.hpp"
#include "support/scenes.hpp"

#include <numbers>
#include <random>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double rest_step = 1e-2;  // [s]

/// A half full box of side 1 m, its surface square to gravity through a point near the middle.
template <int Dim>
Json pool_at_angle(const Vec<Dim>& up, const Vec<Dim>& point, int cells, int per_cell) {
  Json scene = Json::parse(R"({"fluid": {"density": 1000, "viscosity": 0}, "time": {"end": 10},
    "quadrature": {"scheme": "exact"}})");
  scene["time"]["step"] = rest_step;
  scene["dimension"] = Dim;
  const auto vector = [](const auto& value) { return std::vector<double>(value.data(), value.data() + Dim); };
  scene["grid"]["low"] = std::vector<double>(Dim, 0.0);
  scene["grid"]["high"] = std::vector<double>(Dim, 1.0);
  scene["grid"]["cells"] = std::vector<int>(Dim, cells);
  scene["body_force"] = vector(Vec<Dim>(-9.81 * up));
  Json particles;
  particles["shape"]["half_space"]["point"] = vector(point);
  particles["shape"]["half_space"]["normal"] = vector(up);
  particles["per_cell"] = per_cell;
  scene["particles"] = Json::array();
  scene["particles"].push_back(particles);
  return scene;
}

template <int Dim>
double speed_of_fastest(World& world) {
  Largest largest;
  for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) largest.add(v.norm());
  return largest.value();
}

/// Largest speed of a particle between two times. [m/s]
double speed_between(const Json& scene, double from, double until) {
  SceneRun run(scene);
  Largest largest;
  while (run.world().resource<Clock>().time < until) {
    run.step();
    if (run.world().resource<Clock>().time > from) largest.add(speed_of_fastest<2>(run.world()));
  }
  return largest.value();
}

/// Largest speed in the last of eight seconds. [m/s]
template <int Dim>
double late_unrest(const Json& scene) {
  SceneRun run(scene);
  run.step(static_cast<int>(7 / rest_step));
  Largest largest;
  for (int k = 0; k < static_cast<int>(1 / rest_step); ++k) {
    run.step();
    largest.add(speed_of_fastest<Dim>(run.world()));
  }
  return largest.value();
}

}  // namespace

TEST_CASE("water rests at any angle of gravity to the grid, in 2-D", "[verification][long]") {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> share(0, 1);
  const double angle = std::numbers::pi * (0.02 + 0.21 * share(random));
  const Vec<2> up(std::sin(angle), std::cos(angle));
  const Vec<2> point(0.5, 0.5 + 0.05 * share(random));
  Json scene = pool_at_angle<2>(up, point, 20, 3);
  const bool is_viscous = GENERATE(false, true);
  if (is_viscous) scene["fluid"]["viscosity"] = 5;
  const int degree = GENERATE(2, 3);
  scene["discretization"]["scheme"] = "conforming";
  scene["discretization"]["degree"] = degree;
  CAPTURE(angle, degree, is_viscous);
  // Forces by particles let it grow from what the lattice leaves: 0.13 and 0.05 m/s with degree 2 and 3 at 25 degrees,
  // 0.03 and 0.016 where it is viscous. Exact ones leave 0.002 to 0.013.
  CHECK(late_unrest<2>(scene) < 0.015);
}

TEST_CASE("water of 2 x 2 particles rests for long at an angle at which multipliers go unseen",
          "[verification][long]") {
  // Next to every line of the grid the surface reaches multipliers that no particle touches. Without their pressure
  // water went round slowly until its particles were out of order, 0.19 m/s; 0.003 now.
  const double angle = 3 * std::numbers::pi / 180;
  const Vec<2> up(std::sin(angle), std::cos(angle));
  Json scene = pool_at_angle<2>(up, {0.5, 0.5}, 40, 2);
  scene["fluid"]["viscosity"] = 1e-3;
  scene["time"] = Json::parse(R"({"end": 40, "step": 0.0084})");
  CHECK(speed_between(scene, 0.5, 40) < 0.015);
}

TEST_CASE("water rests at any angle of gravity to the grid, in 3-D", "[verification]") {
  const Vec<3> up = Vec<3>(-1, 5, -2).normalized();
  CHECK(late_unrest<3>(pool_at_angle<3>(up, {0.5, 0.52, 0.47}, 10, 2)) < 0.012);  // forces by particles: 0.16
}

TEST_CASE("water rests in 3-D with the defaults, at an angle and near bodies", "[verification][long]") {
  // Forces by particles let it run: 0.075, 0.017, 0.018 m/s here, and growing.
  const std::string pool = GENERATE(
      R"({"body_force": [1.79, 3.58, -8.96], "shape": {"half_space": {"point": [0.5, 0.5, 0.45], "normal": [-1, -2, 5]}}})",
      R"({"shape": {"half_space": {"point": [0, 0, 0.43], "normal": [0, 0, 1]}},
          "body": {"half_space": {"point": [0.9, 0.5, 0.4], "normal": [-0.5, -0.3, 1]}}})",
      R"({"shape": {"half_space": {"point": [0, 0, 0.43], "normal": [0, 0, 1]}},
          "body": {"box": {"low": [0.31, 0.37, -1], "high": [0.55, 0.62, 2]}}})");
  const Json given = Json::parse(pool);
  Json scene = Json::parse(R"({"dimension": 3, "grid": {"low": [0, 0, 0], "high": [1, 1, 1], "cells": [12, 12, 12]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, 0, -9.81], "time": {"end": 9}})");
  if (given.contains("body_force")) scene["body_force"] = given["body_force"];
  scene["particles"] = Json::array();
  scene["particles"].push_back({{"shape", given["shape"]}, {"per_cell", 2}});
  if (given.contains("body")) scene["bodies"].push_back({{"name", "body"}, {"shape", given["body"]}});
  scene["time"]["step"] = 0.015;
  CAPTURE(pool);
  SceneRun run(scene);
  run.step(200);
  CHECK(speed_of_fastest<3>(run.world()) < 0.01);
}

TEST_CASE("two liquids, one above the other, rest at an angle", "[verification]") {
  Json scene = pool_at_angle<2>(Vec<2>(0.4, 1).normalized(), {0.5, 0.5}, 20, 3);
  scene.erase("fluid");
  scene["fluids"] =
      Json::parse(R"({"oil": {"density": 800, "viscosity": 0}, "water": {"density": 1000, "viscosity": 0}})");
  scene["particles"] = Json::parse(R"([
    {"shape": {"where": "0.4*(x - 0.5) + y < 0.4"}, "per_cell": 3, "fluid": "water"},
    {"shape": {"where": "0.4*(x - 0.5) + y >= 0.4 && 0.4*(x - 0.5) + y < 0.65"}, "per_cell": 3, "fluid": "oil"}])");
  CHECK(late_unrest<2>(scene) < 0.02);
}

TEST_CASE("the edge of a pool on a beach rests, wherever it is in the grid", "[verification]") {
  // No multiplier is full near it, and some that hold a part of it no particle touches. Without what (E133) and (E135)
  // have for that 0.10 m/s in the first pool, at once; in the second 0.18 m/s when a particle has crept away, at 4 s.
  struct Pool {
    double right, up, level, slope, foot;
    int per_cell;
    double end;
  };
  const Pool pool = GENERATE(Pool{0.027, 0.0285, 0.3, 0.5, 1, 3, 1.5}, Pool{0, 0, 0.31, 0.7, 1.013, 2, 6});
  Json scene = Json::parse(R"({"dimension": 2, "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": [0, -9.81], "particles": [{"shape": {"half_space": {"normal": [0, 1]}}}],
    "bodies": [{"name": "beach", "shape": {"half_space": {}}}], "time": {"end": 9, "step": 0.0119}})");
  scene["grid"] = {
      {"low", {-pool.right, -pool.up}}, {"high", {2.05 - pool.right, 0.65 - pool.up}}, {"cells", {41, 13}}};
  scene["bodies"][0]["shape"]["half_space"] = {{"point", {pool.foot, 0}}, {"normal", {-pool.slope, 1}}};
  scene["particles"][0]["per_cell"] = pool.per_cell;
  scene["particles"][0]["arrangement"] = "cut";
  scene["particles"][0]["shape"]["half_space"]["point"] = {0, pool.level};
  CAPTURE(pool.slope, pool.level);
  CHECK(speed_between(scene, 0.4, pool.end) < 0.02);
}

TEST_CASE("water rests near bodies, wherever they are in the grid", "[verification][long]") {
  // On a beach, around a post, in a tank and in one that is turned; places and heights by chance. With "mixed" the
  // fastest particle has 0.22 m/s around the post and 0.27 m/s in the turned tank from 4 to 8 s; on the beach and in
  // the straight tank water rests here with both.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  const std::string shape = GENERATE(R"({"half_space": {"point": [1.2, 0], "normal": [-0.5, 1]}})",
                                     R"({"box": {"low": [0.43, -1], "high": [0.57, 1]}})",
                                     R"({"invert": {"box": {"low": [0.11, 0.12], "high": [0.92, 1]}}})",
                                     R"({"invert": {"box": {"low": [0.2, 0.2], "high": [0.8, 0.8], "angle": 25}}})");
  Json scene = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"half_space": {"normal": [0, 1]}}}], "bodies": [{"name": "body"}], "time": {"end": 9, "step": 0.0119}})");
  const double right = 0.05 * share(random);
  const double up = 0.05 * share(random);
  for (const char* corner : {"low", "high"}) {
    scene["grid"][corner][0] = scene["grid"][corner][0].get<double>() - right;
    scene["grid"][corner][1] = scene["grid"][corner][1].get<double>() - up;
  }
  scene["particles"][0]["shape"]["half_space"]["point"] = Json({0.0, 0.5});
  scene["bodies"][0]["shape"] = Json::parse(shape);
  CAPTURE(shape, right, up);
  CHECK(speed_between(scene, 4, 8) < 0.02);
}

TEST_CASE("an eddy in a corner of a tank does not grow, however short the steps are", "[verification]") {
  // Particles bring what they take from closed faces back to open ones in every step. With slopes that few faces tell
  // of the eddy under the surface has 1.2 m/s after 3.5 s; 0.003 with these.
  SceneRun run(
      Json::parse(R"({"dimension": 2, "grid": {"low": [-0.0995, -0.1], "high": [1.1005, 1.1], "cells": [24, 24]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"half_space": {"point": [0, 0.311], "normal": [0, 1]}}, "per_cell": 2}],
    "bodies": [{"name": "tank", "shape": {"invert": {"polygon": {"vertices":
      [[0.478, -0.065], [1.065, 0.479], [0.522, 1.065], [-0.065, 0.522]]}}}}], "time": {"end": 4, "step": 0.001}})"));
  run.step(3500);
  CHECK(speed_of_fastest<2>(run.world()) < 0.03);
}

TEST_CASE("a column of water between a wall and the first line of the grid in front of it does not rise and fall",
          "[verification]") {
  // Particles of the multiplier in the wall, 0.27 open, tell where the surface is: else the column has 0.3 m/s.
  SceneRun run(
      Json::parse(R"({"dimension": 2, "grid": {"low": [-0.2125, -0.2215], "high": [1.1875, 0.5785], "cells": [28, 16]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.31]}}, "per_cell": 2, "arrangement": "cut"}],
    "bodies": [{"name": "tank", "shape": {"invert": {"box": {"low": [0, 0], "high": [1, 0.6]}}}}],
    "time": {"end": 5, "step": 0.0119}})"));
  run.step(168);
  Largest largest;
  for (int k = 0; k < 168; ++k) {
    run.step();
    largest.add(speed_of_fastest<2>(run.world()));
  }
  CHECK(largest.value() < 0.01);
}
