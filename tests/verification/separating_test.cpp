/// \file
/// Walls that the liquid may leave: free fall from under a lid, rest, impact, energy.

#include "support/energy.hpp"
#include "support/extremes.hpp"
#include "support/scene_run.hpp"

#include "components/contact.hpp"
#include "components/measure.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double g = 9.81;  // [m/s^2]

double column(World& world, const std::string& name) {
  const double* value = world.resource<measure::Columns>().find(name);
  REQUIRE(value != nullptr);
  return *value;
}

/// A block of liquid in a box of 1 m, 10 cells along every axis, that touches the lid.
Json under_lid(int dimension, const std::string& lid) {
  Json scene = Json::parse(R"json({"fluid": {"density": 1000, "viscosity": 0}, "time": {"end": 1, "step": 0.01}})json");
  const auto all = [&](double value) { return Json(std::vector<double>(static_cast<std::size_t>(dimension), value)); };
  scene["dimension"] = dimension;
  scene["grid"] = {{"low", all(0)}, {"high", all(1)}};
  scene["grid"]["cells"] = std::vector<int>(static_cast<std::size_t>(dimension), 10);
  Json low = all(0.3);
  Json high = all(0.7);
  Json force = all(0);
  const std::string up = dimension == 2 ? "y" : "z";
  low[low.size() - 1] = 0.6;
  high[high.size() - 1] = 1;
  force[force.size() - 1] = -g;
  scene["particles"] = {{{"shape", {{"box", {{"low", low}, {"high", high}}}}}, {"per_cell", 2}}};
  scene["body_force"] = force;
  scene["walls"][up] = {"slip", lid};
  return scene;
}

/// How far the particles are from where they would be in free fall, at most. [m]
template <int Dim>
double off_free_fall(SceneRun& run, int steps, double dt) {
  const auto x0 = by_id<particle::Position<Dim>>(run.world());
  run.step(steps);
  const auto x = by_id<particle::Position<Dim>>(run.world());
  const double t = steps * dt;
  Largest off;
  for (std::size_t p = 0; p < x.size(); ++p) off.add((x[p] - x0[p] + g * t * t / 2 * Vec<Dim>::Unit(Dim - 1)).norm());
  return off.value();
}

/// A tank of 1 m x 1 m, half full, at rest.
Json still(const std::string& wall, const std::string& force) {
  Json scene = Json::parse(R"json({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
    "fluid": {"density": 1000, "viscosity": 1e-3},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2}],
    "time": {"end": 1, "step": 0.002}})json");
  scene["walls"] = wall;
  scene["body_force"] = Json::parse(force);
  return scene;
}

double largest_speed(World& world) { return world.resource<measure::MaxSpeed>().value; }

/// A channel of 1 m with liquid from the piston at x = 0.5185 m to x = 1.5 m, without gravity.
Json piston(const std::string& velocity, const std::string& wall) {
  Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [2, 0.5], "cells": [40, 10]}, "fluid": {"density": 1000, "viscosity": 0},
    "particles": [{"shape": {"box": {"low": [0.5, 0], "high": [1.5, 0.5]}}, "per_cell": 2}],
    "bodies": [{"name": "piston", "shape": {"box": {"low": [-0.5, -1], "high": [0.5185, 1.5]}}}],
    "volume": {"scheme": "none"}, "time": {"end": 1, "step": 0.005}})json");
  scene["bodies"][0]["motion"]["prescribed"]["velocity"] = {velocity, 0};
  scene["bodies"][0]["wall"] = wall;
  return scene;
}

}  // namespace

TEST_CASE("liquid under a separating lid falls freely", "[verification]") {
  const auto scheme = GENERATE("tpic", "tpic2", "flip", "apic");
  const int degree = GENERATE(2, 3);
  CAPTURE(scheme, degree);
  Json scene = with(under_lid(2, "separating"),
                    {R"(/transfer={"scheme": ")" + std::string(scheme) + "\"}",
                     R"(/discretization={"scheme": "conforming", "degree": )" + std::to_string(degree) + "}",
                     R"(/volume={"scheme": "none"})"});
  SceneRun run(scene);
  CHECK(off_free_fall<2>(run, 20, 0.01) < 1e-10);
  CHECK(column(run.world(), "contact_unsettled") == 0);
}

TEST_CASE("the volume correction does not hold liquid at a separating lid", "[verification]") {
  SceneRun run(under_lid(2, "separating"));
  CHECK(off_free_fall<2>(run, 20, 0.01) < 1e-10);
}

TEST_CASE("liquid under a separating lid falls freely in 3-D", "[verification]") {
  SceneRun run(under_lid(3, "separating"));
  CHECK(off_free_fall<3>(run, 20, 0.01) < 1e-10);
}

TEST_CASE("liquid under a slip lid hangs there", "[verification]") {
  SceneRun run(under_lid(2, "slip"));
  CHECK(off_free_fall<2>(run, 20, 0.01) > 0.1);
}

TEST_CASE("water at rest presses separating walls as it presses slip walls", "[verification]") {
  // On exact integrals .25 mm apart, where q_f counted faces that a separating side holds.
  const std::string quadrature = GENERATE("mixed", "exact");
  const auto force = GENERATE("[0, -9.81]", "[0, 0]");
  CAPTURE(quadrature, force);
  const auto run_of = [&](const char* wall) {
    return SceneRun(with(still(wall, force), {"/quadrature={\"scheme\": \"" + quadrature + "\"}"}));
  };
  SceneRun separating = run_of("separating");
  SceneRun slip = run_of("slip");
  separating.step(100);
  slip.step(100);
  const auto x = by_id<particle::Position<2>>(separating.world());
  const auto x_slip = by_id<particle::Position<2>>(slip.world());
  Largest apart;
  for (std::size_t p = 0; p < x.size(); ++p) apart.add((x[p] - x_slip[p]).norm());
  CHECK(apart.value() < 1e-12);
  CHECK(column(separating.world(), "contact_unsettled") == 0);
}

TEST_CASE("liquid that fills a box stays in contact with its separating walls", "[verification]") {
  Json scene = still("separating", "[1, -9.81]");
  scene["particles"][0]["shape"]["box"]["high"] = {1, 1};
  SceneRun run(scene);
  run.step(100);
  CHECK(largest_speed(run.world()) < 1e-8);
  CHECK(column(run.world(), "contact_unsettled") == 0);
}

TEST_CASE("a block thrown against a separating lid comes back with no more energy", "[verification]") {
  const auto wall = GENERATE("separating", "slip");
  CAPTURE(wall);
  Json scene = with(under_lid(2, wall), {"/time/step=0.002", R"(/particles/0/velocity=["0", "4"])"});
  scene["particles"][0]["shape"]["box"] = {{"low", {0.3, 0.4}}, {"high", {0.7, 0.8}}};
  SceneRun run(scene);
  const double rise = rise_of_energy(run, 200);
  Largest highest;
  for (const auto& x : run.world().column<particle::Position<2>>()) highest.add(x[1]);
  if (wall == std::string("slip")) {
    CHECK(highest.value() > 0.99);
  } else {
    CHECK(highest.value() < 0.9);
    CHECK(rise < 1e-3);
  }
}

TEST_CASE("a dam that breaks in a low box of separating walls gains no energy", "[verification][long]") {
  Json scene = scene_of_file("wave_under_lid.json");
  const auto walls = GENERATE(R"({"y": ["slip", "separating"]})", R"("separating")");
  CAPTURE(walls);
  scene["walls"] = Json::parse(walls);
  SceneRun run(scene);
  CHECK(rise_of_energy(run, 500) < 1e-3);
  CHECK(column(run.world(), "contact_unsettled") == 0);
}

TEST_CASE("liquid under a separating body falls freely", "[verification]") {
  // Across a cell particles are cut, too, and the volume correction moves them.
  const auto [bottom, volume] =
      GENERATE(table<double, const char*>({{0.9, "none"}, {0.9, "projection"}, {0.87, "none"}}));
  CAPTURE(bottom, volume);
  const auto falling = [bottom = bottom, volume = volume](const std::string& wall) {
    Json scene = under_lid(2, "slip");
    scene["bodies"] = {
        {{"name", "lid"}, {"wall", wall}, {"shape", {{"box", {{"low", {0.1, bottom}}, {"high", {0.9, 2}}}}}}}};
    scene["volume"]["scheme"] = volume;
    SceneRun run(scene);
    return off_free_fall<2>(run, 20, 0.01);
  };
  CHECK(falling("separating") < 1e-10);
  CHECK(falling("slip") > 0.1);
}

TEST_CASE("liquid under a separating body falls freely in 3-D", "[verification]") {
  Json scene = under_lid(3, "slip");
  scene["bodies"] = Json::parse(
      R"([{"name": "lid", "wall": "separating", "shape": {"box": {"low": [0.1, 0.1, 0.87], "high": [0.9, 0.9, 2]}}}])");
  scene["volume"]["scheme"] = "none";
  SceneRun run(scene);
  CHECK(off_free_fall<3>(run, 20, 0.01) < 1e-10);
}

TEST_CASE("liquid that falls from a separating body goes on with the adjacent body", "[verification]") {
  // Two lids side by side, across a cell; what is attached to the second.
  const auto attached = [](const std::string& first) {
    Json scene = under_lid(2, "slip");
    scene["bodies"] = {
        {{"name", "first"}, {"wall", first}, {"shape", {{"box", {{"low", {0.1, 0.87}}, {"high", {0.48, 2}}}}}}},
        {{"name", "second"}, {"shape", {{"box", {{"low", {0.48, 0.87}}, {"high", {0.9, 2}}}}}}}};
    scene["volume"]["scheme"] = "none";
    SceneRun run(scene);
    run.step();
    double sum = 0;
    const auto mass = run.world().column<face::AttachedMass<2>>();
    for (std::size_t i = 0; i < mass.size(); ++i) {
      for (std::size_t d = 0; d < 2; ++d) {
        if (run.world().column<face::AttachedTo<2>>()[i][d] == 1) sum += std::abs(mass[i][static_cast<int>(d)]);
      }
    }
    return sum;
  };
  CHECK(attached("slip") > 0);
  CHECK(attached("separating") == Approx(attached("slip")).epsilon(1e-12));
}

TEST_CASE("a separating piston that goes away leaves the liquid where it is", "[verification]") {
  const auto largest_displacement = [](const std::string& wall) {
    SceneRun run(piston("-t", wall));
    const auto x0 = by_id<particle::Position<2>>(run.world());
    run.step(100);
    const auto x = by_id<particle::Position<2>>(run.world());
    Largest moved;
    for (std::size_t p = 0; p < x.size(); ++p) moved.add((x[p] - x0[p]).norm());
    return moved.value();
  };
  CHECK(largest_displacement("separating") < 1e-12);
  CHECK(largest_displacement("slip") == Approx(0.125).epsilon(0.02));
}

TEST_CASE("the liquid never pulls at a separating piston", "[verification]") {
  const auto most_pull = [](const std::string& wall) {
    SceneRun run(piston("0.3*sin(8*t)", wall));
    Largest pull;
    Largest push;
    for (int n = 0; n < 200; ++n) {
      run.step();
      pull.add(column(run.world(), "piston_force_x"));
      push.add(-column(run.world(), "piston_force_x"));
    }
    return pull.value() / push.value();
  };
  CHECK(most_pull("separating") < 1e-6);
  CHECK(most_pull("slip") > 0.5);
}

TEST_CASE("water at rest presses a separating body as it presses one with slip", "[verification]") {
  const auto at_rest = [](const std::string& wall) {
    Json scene = still("slip", "[0, -9.81]");
    scene["bodies"] = {{{"name", "box"},
                        {"wall", wall},
                        {"shape", {{"box", {{"low", {0.33, -1}}, {"high", {0.61, 0.24}}, {"angle", 10}}}}}}};
    auto run = std::make_unique<SceneRun>(scene);
    run->step(50);
    return run;
  };
  const auto separating = at_rest("separating");
  const auto slip = at_rest("slip");
  const auto x = by_id<particle::Position<2>>(separating->world());
  const auto x_slip = by_id<particle::Position<2>>(slip->world());
  Largest apart;
  for (std::size_t p = 0; p < x.size(); ++p) apart.add((x[p] - x_slip[p]).norm());
  CHECK(apart.value() < 1e-12);
  CHECK(column(separating->world(), "box_force_y") == Approx(column(slip->world(), "box_force_y")).epsilon(1e-9));
}

TEST_CASE("a free body leaves a wet floor without suction", "[verification]") {
  // A plate in shallow water, drawn up by a spring that is stronger than its weight.
  const auto run_of = [](const std::string& wall) {
    Json scene = Json::parse(R"json({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 0.5], "cells": [40, 20]},
      "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, -9.81],
      "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.1]}}, "per_cell": 2}],
      "bodies": [{"name": "plate", "shape": {"box": {"low": [0.3, 0.06], "high": [0.7, 0.16]}},
                  "motion": {"free": {"density": 500, "locked": ["x", "rotation"],
                                      "spring": {"to": [0.5, 0.6], "stiffness": 4000}}}}],
      "time": {"end": 1, "step": 0.002}})json");
    scene["bodies"][0]["wall"] = wall;
    auto run = std::make_unique<SceneRun>(scene);
    Smallest force;
    for (int n = 0; n < 60; ++n) {
      run->step();
      force.add(column(run->world(), "plate_force_y"));
    }
    return std::pair(force.value(), column(run->world(), "plate_position_y"));
  };
  const auto [separating, height] = run_of("separating");
  const auto [slip, height_slip] = run_of("slip");
  const double weight = 0.4 * 0.1 * 500 * g;
  CHECK(separating > -1e-6 * weight);
  CHECK(slip < -0.1 * weight);
  CHECK(height > height_slip);
}
