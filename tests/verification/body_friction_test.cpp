/// \file
/// Friction at the walls of bodies against exact solutions: flow between turning cylinders and spheres, in a channel
/// across the grid, along walls with a slip length; what it keeps, and that water hardly feels it.

#include "support/extremes.hpp"
#include "support/scene_run.hpp"

#include "components/body.hpp"
#include "components/measure.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/viscosity/wall_friction.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double pi = 3.14159265358979;

/// Flow between cylinders at its end, with a gap of cells/4.4 cells.
void run_couette(SceneRun& run) { run.step(60); }

Json couette(int cells) {
  Json scene = with(scene_of_file("couette.json"), {});
  scene["grid"]["cells"] = {cells, cells};
  return scene;
}

/// Torque of the inner cylinder at r = 0.5 that turns with 1/s in a drum of 1 m, for a slip length at its wall.
double exact_torque(double slip_length) { return 4 * pi * 0.5 / (1.5 + 8 * slip_length); }

}  // namespace

TEST_CASE("flow between a turning cylinder and a drum, with the torques on both", "[verification][long]") {
  const auto [cells, error, of_torque] =
      GENERATE(table<int, double, double>({{22, 0.025, 0.04}, {44, 0.012, 0.012}}));  // 0.017, 0.006; 2.1 %, 0.9 %
  CAPTURE(cells);
  SceneRun run(couette(cells));
  run_couette(run);
  CHECK(measured(run.world(), "error_velocity") < error);
  CHECK(measured(run.world(), "cylinder_friction_torque") == Approx(-exact_torque(0)).epsilon(of_torque));
  CHECK(measured(run.world(), "drum_friction_torque") == Approx(exact_torque(0)).epsilon(of_torque));
}

TEST_CASE("a cylinder with a slip length takes less liquid along", "[verification][long]") {
  const double slip_length = GENERATE(1.0, 0.1, 0.01);
  CAPTURE(slip_length);
  Json scene = couette(44);
  scene["bodies"][0]["wall"] = {{"slip_length", slip_length}};
  scene.erase("exact");
  SceneRun run(scene);
  run_couette(run);
  CHECK(measured(run.world(), "cylinder_friction_torque") == Approx(-exact_torque(slip_length)).epsilon(0.03));
}

TEST_CASE("flow between a turning ball and a sphere around it", "[verification][long]") {
  SceneRun run(Json::parse(R"json({"dimension": 3,
    "grid": {"low": [-1.1, -1.1, -1.1], "high": [1.1, 1.1, 1.1], "cells": [18, 18, 18]},
    "fluid": {"density": 1, "viscosity": 1},
    "particles": [{"shape": {"ball": {"center": [0, 0, 0], "radius": 1}}, "per_cell": 2}],
    "bodies": [
      {"name": "ball", "shape": {"ball": {"center": [0, 0, 0], "radius": 0.5}}, "wall": "no_slip",
       "motion": {"prescribed": {"velocity": [0, 0, 0], "rotation": {"rate": 0.1}}}},
      {"name": "shell", "shape": {"invert": {"ball": {"center": [0, 0, 0], "radius": 1}}}, "wall": "no_slip"}],
    "time": {"end": 1, "step": 0.02}})json"));
  run.step(10);
  // Stokes flow: 8 pi mu omega a^3 b^3/(b^3 - a^3).
  const double torque = 8 * pi * 0.1 * 0.125 / 0.875;
  CHECK(measured(run.world(), "ball_friction_torque_z") == Approx(-torque).epsilon(0.1));
  CHECK(measured(run.world(), "shell_friction_torque_z") == Approx(torque).epsilon(0.1));
  CHECK(std::abs(measured(run.world(), "ball_friction_torque_x")) < 0.01 * torque);
}

TEST_CASE("flow in a channel across the grid, wherever its walls cut cells", "[verification][long]") {
  // Walls along the diagonal, periodic, 10.7 to 22 cells of h between them.
  const auto [cells, error] =
      GENERATE(table<int, double>({{19, 0.025}, {24, 0.012}, {35, 0.008}, {39, 0.009}}));  // 0.013 0.006 0.004 0.005
  CAPTURE(cells);
  Json scene = Json::parse(R"json({"dimension": 2, "constants": {"W": 1, "L": 1.76776695},
    "grid": {"low": [0, 0], "high": ["L", "L"]}, "walls": {"x": "periodic", "y": "periodic"},
    "fluid": {"density": 1, "viscosity": 1}, "body_force": ["8/sqrt(2)", "8/sqrt(2)"],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": ["L", "L"]}}, "per_cell": 3}],
    "bodies": [{"name": "walls", "wall": "no_slip",
      "shape": {"distance": "W/2 - min(abs(x - y)/sqrt(2), abs(L/sqrt(2) - abs(x - y)/sqrt(2)))"}}],
    "volume": {"scheme": "none"}, "time": {"end": 2, "step": 0.04},
    "exact": {"velocity": [
      "(1 - 4*min(abs(x - y)/sqrt(2), abs(L/sqrt(2) - abs(x - y)/sqrt(2)))^2)/sqrt(2)",
      "(1 - 4*min(abs(x - y)/sqrt(2), abs(L/sqrt(2) - abs(x - y)/sqrt(2)))^2)/sqrt(2)"]}})json");
  scene["grid"]["cells"] = {cells, cells};
  SceneRun run(scene);
  run.step(30);
  CHECK(measured(run.world(), "error_velocity") < error);
  // Walls take what the body force gives.
  CHECK(measured(run.world(), "walls_friction_x") + measured(run.world(), "walls_force_x") ==
        Approx(14.14).epsilon(0.02));
}

namespace {

/// The friction operator of a step with a body of every kind of wall.
struct WallOperator {
  World& world;
  FrictionOf<2> of{world.resource<Splines<2>>(),      world.resource<FrictionMatrices<2>>(),
                   world.resource<GridCells<2>>(),    world.resource<CellSites>(),
                   world.column<cell::Viscosity>(),   &world.resource<FaceExtension<2>>(),
                   &world.resource<CutFriction<2>>(), &world.resource<FrictionAtRest<2>>()};
  std::vector<double> x = std::vector<double>(2 * world.rows<Staggered>());

  std::vector<double> apply(const std::vector<double>& v, WallsMove move,
                            std::vector<RigidVector<2>>* on_walls = nullptr) {
    std::vector<double> out(v.size());
    apply_wall_friction<2>(of, move, {}, v, x, out, on_walls);
    return out;
  }
};

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// A number between -1 and 1 that differs from face to face.
std::vector<double> scattered(std::size_t count, int seed) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k] = std::sin(12.9898 * static_cast<double>(k) + seed);
  return values;
}

}  // namespace

TEST_CASE("friction near bodies is symmetric, dissipates, and takes no momentum", "[property]") {
  const int degree = GENERATE(2, 3);
  CAPTURE(degree);
  Json scene = couette(22);
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  scene["bodies"][0]["wall"] = {{"slip_length", 0.1}};
  scene["bodies"][0]["motion"]["prescribed"]["velocity"] = {0.3, -0.2};
  scene.erase("exact");
  SceneRun run(scene);
  run.step(1);
  WallOperator friction{run.world()};
  const std::size_t n = friction.x.size();
  const std::vector<double> v = scattered(n, 1);
  const std::vector<double> w = scattered(n, 2);
  const double vKw = dot(v, friction.apply(w, WallsMove::no));
  CHECK(dot(w, friction.apply(v, WallsMove::no)) == Approx(vKw).epsilon(1e-12));
  CHECK(dot(v, friction.apply(v, WallsMove::no)) > 0);

  // What the faces get and what the walls get is nothing together.
  std::vector<RigidVector<2>> on_walls(2, RigidVector<2>::Zero());
  const std::vector<double> pull = friction.apply(v, WallsMove::yes, &on_walls);
  for (std::size_t d = 0; d < 2; ++d) {
    double sum = 0;
    double size = 0;
    for (std::size_t k = d; k < n; k += 2) {
      sum -= pull[k];
      size += std::abs(pull[k]);
    }
    for (const RigidVector<2>& on_wall : on_walls) sum += on_wall[static_cast<Eigen::Index>(d)];
    CHECK(std::abs(sum) < 1e-12 * size);
  }
}

TEST_CASE("a liquid that moves with all walls has no friction", "[property]") {
  Json scene = couette(22);
  const Json wall = GENERATE(Json("no_slip"), Json{{"slip_length", 0.2}});
  const double spin = GENERATE(0.0, 2.0);
  scene["bodies"][0]["motion"]["prescribed"] = {{"velocity", {0.3, -0.2}},
                                                {"rotation", {{"center", {0, 0}}, {"rate", spin}}}};
  scene["bodies"][1]["motion"] = scene["bodies"][0]["motion"];
  for (Json& body : scene["bodies"]) body["wall"] = wall;
  scene.erase("exact");
  SceneRun run(scene);
  run.step(1);
  WallOperator friction{run.world()};
  const SitePlaces<2> places(run.world().resource<Grid<2>>(), run.world().resource<Splines<2>>());
  const Vec<2> center = run.world().column<body::MiddlePosition<2>>()[0];
  std::vector<double> v;
  for (const Index<2>& site : run.world().column<staggered::Site<2>>()) {
    for (std::size_t d = 0; d < 2; ++d)
      v.push_back(
          rigid_velocity({0.3, -0.2}, Vec<1>(spin), places.face(site, d) - center)[static_cast<Eigen::Index>(d)]);
  }
  std::vector<RigidVector<2>> on_walls(2, RigidVector<2>::Zero());
  double largest = 0;
  for (const double pull : friction.apply(v, WallsMove::yes, &on_walls)) largest = largest_of(largest, std::abs(pull));
  CHECK(std::isfinite(largest));
  // Slopes that few faces tell of are taken for less than they are, by 1e-3; a wall at rest would feel 8 N and more.
  const double most = spin == 0 ? 1e-11 : 0.01;
  CHECK(largest < most);
  for (const RigidVector<2>& on_wall : on_walls) CHECK(on_wall.norm() < 2 * most);
}

TEST_CASE("water hardly feels that it sticks to a body, and gives it the work that it loses", "[verification]") {
  const auto run_with = [](const Json& wall) {
    Json scene = with(scene_of_file("obstacle.json"), {"/grid/cells=[40, 40]", "/time/step=0.002"});
    scene["bodies"][0]["wall"] = wall;
    SceneRun run(scene);
    run.step(200);
    return measured(run.world(), "energy_balance");
  };
  const double slips = run_with("slip");
  CHECK(run_with("no_slip") == Approx(slips).epsilon(0.03));
  CHECK(run_with({{"slip_length", 1e-3}}) == Approx(slips).epsilon(0.03));
}

TEST_CASE("a yield-stress liquid comes to rest around a body", "[verification]") {
  SceneRun run(Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 0.5], "cells": [24, 12]}, "walls": "no_slip",
    "fluid": {"density": 1000, "rheology": {"bingham": {"yield_stress": 400, "viscosity": 20}}},
    "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.3, 0.4]}}, "per_cell": 2}],
    "bodies": [{"name": "post", "shape": {"ball": {"center": [0.5, 0.05], "radius": 0.1}}, "wall": "no_slip"}],
    "time": {"end": 2, "step": 0.01}})json"));
  run.step(40);
  CHECK(measured(run.world(), "post_friction_x") + measured(run.world(), "post_force_x") > 0);
  CHECK(run.world().resource<measure::MaxSpeed>().value < 0.3);
}
