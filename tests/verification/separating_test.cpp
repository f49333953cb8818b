/// \file
/// Walls that the liquid may leave: free fall from under a lid, rest, impact, energy.

#include "support/extremes.hpp"
#include "support/scene_run.hpp"

#include "components/contact.hpp"
#include "components/measure.hpp"

#include <catch2/catch.hpp>

#include <cmath>

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

double total_energy(World& world) {
  const auto& energy = world.resource<measure::Energy>();
  return energy.kinetic + energy.potential.value_or(0);
}

}  // namespace

TEST_CASE("liquid under a separating lid falls freely", "[verification]") {
  const auto scheme = GENERATE("tpic", "tpic2", "flip", "apic");
  const int degree = GENERATE(2, 3);
  CAPTURE(scheme, degree);
  Json scene = with(under_lid(2, "separating"), {R"(/transfer={"scheme": ")" + std::string(scheme) + "\"}",
                                                 R"(/discretization={"scheme": "conforming", "degree": )" +
                                                     std::to_string(degree) + "}",
                                                 R"(/volume={"scheme": "none"})"});
  SceneRun run(scene);
  CHECK(off_free_fall<2>(run, 20, 0.01) < 1e-10);
  CHECK(column(run.world(), "contact_unsettled") == 0);
}

TEST_CASE("the volume correction does not hold liquid at a separating lid", "[verification]") {
  SceneRun run(under_lid(2, "separating"));
  CHECK(off_free_fall<2>(run, 20, 0.01) < 1e-10);
}

TEST_CASE("liquid under a separating lid falls freely in space", "[verification]") {
  SceneRun run(under_lid(3, "separating"));
  CHECK(off_free_fall<3>(run, 20, 0.01) < 1e-10);
}

TEST_CASE("liquid under a slip lid hangs there", "[verification]") {
  SceneRun run(under_lid(2, "slip"));
  run.step(20);
  Largest highest;
  for (const auto& x : run.world().column<particle::Position<2>>()) highest.add(x[1]);
  CHECK(highest.value() > 0.97);
}

TEST_CASE("water at rest presses separating walls as it presses slip walls", "[verification]") {
  const auto force = GENERATE("[0, -9.81]", "[0, 0]");
  CAPTURE(force);
  SceneRun separating(still("separating", force));
  SceneRun slip(still("slip", force));
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
  run.start();
  double least = total_energy(run.world());
  const double at_start = least;
  double rise = 0;
  for (int n = 0; n < 150; ++n) {
    run.step();
    const double energy = total_energy(run.world());
    rise = std::max(rise, energy - least);
    least = std::min(least, energy);
  }
  CHECK(rise < 1e-3 * at_start);
  Largest highest;
  for (const auto& x : run.world().column<particle::Position<2>>()) highest.add(x[1]);
  if (wall == std::string("separating")) {
    CHECK(highest.value() < 0.95);
  } else {
    CHECK(highest.value() > 0.95);
  }
}
