/// \file
/// (E136) Water beside walls thinner than a cell, at angles and offsets of no meaning to the grid.

#include "support/extremes.hpp"
#include "support/folder.hpp"
#include "support/scenes.hpp"
#include "support/solids.hpp"

#include "components/body.hpp"

#include <numbers>
#include <random>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double step = 5e-3;  // [s]

/// A square that is turned, in its own frame 2 `half` wide.
struct Square {
  Vec<2> middle;
  double angle;
  double half;

  Vec<2> to_world(const Vec<2>& x) const { return middle + Eigen::Rotation2D<double>(angle).toRotationMatrix() * x; }
  Vec<2> to_own(const Vec<2>& x) const { return Eigen::Rotation2D<double>(-angle).toRotationMatrix() * (x - middle); }
  bool holds(const Vec<2>& x) const { return to_own(x).cwiseAbs().maxCoeff() < half; }
};

Json point(const Vec<2>& x) { return Json{x[0], x[1]}; }

Json polygon(const Square& square, const std::vector<Vec<2>>& corners) {
  Json shape;
  shape["polygon"]["vertices"] = Json::array();
  for (const Vec<2>& corner : corners) shape["polygon"]["vertices"].push_back(point(square.to_world(corner)));
  return shape;
}

Json filled(const Square& square, double half) {
  return polygon(square, {{-half, -half}, {half, -half}, {half, half}, {-half, half}});
}

/// Without a lid.
Json cup(const Square& square, double wall) {
  const double a = square.half;
  const double b = a + wall;
  return polygon(square, {{-a, a}, {-b, a}, {-b, -b}, {b, -b}, {b, a}, {a, a}, {a, -a}, {-a, -a}});
}

Json closed(const Square& square, double wall) {
  Json shape;
  shape["difference"] = Json::array();
  shape["difference"].push_back(filled(square, square.half + wall));
  shape["difference"].push_back(filled(square, square.half));
  return shape;
}

/// A square of 8 cells, of which what lies below a level is water.
Json water_in(const Square& square, const Json& walls, double level, int per_cell) {
  Json scene = Json::parse(R"({"dimension": 2, "grid": {"low": [-0.8, -0.8], "high": [0.8, 0.8], "cells": [32, 32]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81], "time": {"end": 100}})");
  scene["time"]["step"] = step;
  scene["bodies"] = Json::array();
  scene["bodies"].push_back({{"name", "box"}, {"shape", walls}});
  Json particles;
  Json below;
  below["half_space"]["point"] = Json{0, level};
  below["half_space"]["normal"] = Json{0, 1};
  particles["shape"]["intersection"] = Json::array();
  particles["shape"]["intersection"].push_back(filled(square, square.half));
  particles["shape"]["intersection"].push_back(below);
  particles["per_cell"] = per_cell;
  particles["arrangement"] = "cut";
  scene["particles"] = Json::array();
  scene["particles"].push_back(particles);
  return scene;
}

std::size_t outside(World& world, const Square& square) {
  std::size_t count = 0;
  for (const Vec<2>& x : world.column<particle::Position<2>>()) count += square.holds(x) ? 0 : 1;
  return count;
}

Square any_square(std::mt19937& random, double largest_angle) {
  std::uniform_real_distribution<double> share(-1, 1);
  return {{0.05 * share(random), 0.05 * share(random)}, largest_angle * share(random), 0.2};
}

/// \param thickness  of the walls [h]
void check_rolling(double thickness, int steps) {
  Square square{{0.013, -0.021}, 0.3, 0.2};
  Json scene = water_in(square, closed(square, thickness * 0.05), square.middle[1], 3);
  scene["bodies"][0]["motion"]["prescribed"]["velocity"] = Json{"0", "0"};
  scene["bodies"][0]["motion"]["prescribed"]["rotation"]["rate"] = "1";
  SceneRun run(scene);
  Largest overlap;
  for (int k = 0; k < steps; ++k) {
    run.step();
    overlap.add(run.world().resource<measure::Overlap>().value);
  }
  square.angle += steps * step;
  CHECK(outside(run.world(), square) == 0);
  CHECK(overlap.value() < 0.02);
}

}  // namespace

TEST_CASE("water rests in boxes of thin walls, and none gets through", "[verification][long]") {
  const int seed = GENERATE(1, 2, 3);
  std::mt19937 random(static_cast<unsigned>(seed));
  const bool has_lid = GENERATE(false, true);
  const double thickness = GENERATE(0.05, 0.2, 1.2);  // [h]
  const int per_cell = GENERATE(2, 3);
  const Square square = any_square(random, has_lid ? std::numbers::pi : 0.5);
  CAPTURE(seed, has_lid, thickness, per_cell, square.angle, square.middle);
  const double wall = thickness * 0.05;
  const Json walls = has_lid ? closed(square, wall) : cup(square, wall);
  SceneRun run(water_in(square, walls, square.middle[1] - 0.02, per_cell));
  run.step(static_cast<int>(0.5 / step));
  Largest speed;
  Largest overlap;
  for (int k = 0; k < static_cast<int>(1 / step); ++k) {
    run.step();
    speed.add(run.world().resource<measure::MaxSpeed>().value);
    overlap.add(run.world().resource<measure::Overlap>().value);
  }
  CHECK(outside(run.world(), square) == 0);
  CHECK(speed.value() < 0.02);
  CHECK(overlap.value() < 0.01);
}

TEST_CASE("no water gets out of a box of thin walls that rolls", "[verification][long]") {
  check_rolling(GENERATE(0.05, 0.2), 400);
}

TEST_CASE("no water gets out of a box of thin walls that begins to roll", "[verification]") { check_rolling(0.2, 40); }

TEST_CASE("no water gets out of a closed shell of triangles that is shaken", "[verification][long]") {
  // Of two surfaces, the wall a fifth of a cell thick.
  solids::Triangles shell = solids::ball(2);
  const auto corners = static_cast<std::uint32_t>(shell.corner.size());
  constexpr double inner = 0.2;
  constexpr double outer = 0.212;
  for (std::size_t k = 0; k < corners; ++k) {
    shell.corner.emplace_back(inner * shell.corner[k]);
    shell.corner[k] *= outer;
  }
  for (std::size_t t = 0, count = shell.triangle.size(); t < count; ++t) {
    const auto [a, b, c] = shell.triangle[t];
    shell.triangle.push_back({c + corners, b + corners, a + corners});
  }
  const Folder folder;
  solids::write_binary_stl(folder / "shell.stl", shell);
  Json scene = Json::parse(R"json({"dimension": 3,
    "grid": {"low": [-0.42, -0.42, -0.42], "high": [0.42, 0.42, 0.42], "cells": [14, 14, 14]},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, 0, -9.81],
    "particles": [{"shape": {"intersection": [{"ball": {"center": [0, 0, 0], "radius": 0.18}},
                                              {"half_space": {"point": [0, 0, 0], "normal": [0, 0, 1]}}]},
                   "per_cell": 2, "arrangement": "cut"}],
    "bodies": [{"name": "shell", "motion": {"prescribed": {
      "velocity": ["0.5*sin(13*t)", "0.3*sin(17*t)", "0.3*sin(11*t)"], "rotation": {"axis": [1, 2, 3], "rate": "2"}}}}],
    "time": {"end": 1, "step": 0.01}})json");
  scene["bodies"][0]["shape"]["mesh"]["file"] = folder / "shell.stl";
  SceneRun run(scene);
  Largest overlap;
  for (int k = 0; k < 40; ++k) {
    run.step();
    overlap.add(run.world().resource<measure::Overlap>().value);
  }
  const Vec<3> middle = run.world().column<body::Position<3>>()[0];
  Largest farthest;
  for (const Vec<3>& x : run.world().column<particle::Position<3>>()) farthest.add((x - middle).norm());
  CHECK(farthest.value() < inner);
  CHECK(overlap.value() < 0.02);  // 0.016 measured
}
