#include "systems/time/ode.hpp"

#include "components/particle.hpp"
#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scene_run.hpp"
#include "systems/seeding/seed.hpp"
#include "systems/step/time_plan.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace minamo;
using kernels::run;
using scene_run::SceneRun;

namespace {

/// Rates in t, a, b.
std::vector<Expression> rates(const std::vector<std::string>& texts) {
  const std::vector<std::string> names{"a", "b"};
  ExpressionScope scope{{"t"}, {}};
  for (std::size_t k = 0; k < texts.size(); ++k) scope.variables.push_back(names[k]);
  std::vector<Expression> all;
  for (const std::string& text : texts) all.emplace_back(text, scope);
  return all;
}

Instant start(const std::vector<double>& values) {
  Instant instant;
  instant.ode_count = values.size();
  std::copy(values.begin(), values.end(), instant.ode.begin());
  return instant;
}

/// Over [0, end] in equal steps.
Instant integrated(const std::vector<Expression>& rate, Instant instant, double end, int steps) {
  for (int k = 1; k <= steps; ++k) instant = advance(rate, instant, end * k / steps);
  return instant;
}

const Json accelerated = Json::parse(R"json({
  "dimension": 2, "constants": {"k": 2}, "grid": {"low": [0, 0], "high": [2, 2], "cells": [16, 16]},
  "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, "-g"], "ode": {"g": {"start": 1, "rate": "k"}},
  "particles": [{"shape": {"box": {"low": [0.75, 0.75], "high": [1.25, 1.25]}}, "velocity": ["3*g", 0]}],
  "integrator": {"scheme": "midpoint"}, "time": {"end": 1, "step": 0.01}})json");

}  // namespace

TEST_CASE("an ode variable that grows with itself is the exponential function", "[unit]") {
  const int steps = GENERATE(1, 10, 1000);
  CAPTURE(steps);
  const Instant end = integrated(rates({"a"}), start({1}), 1, steps);
  CHECK(end.time == 1);
  // The error of one step, or roundings of 1000: 5e-14 measured.
  CHECK(std::abs(end.ode[0] / std::numbers::e - 1) < 5e-13);
}

TEST_CASE("an ode variable follows a rate in time", "[unit]") {
  const Instant end = integrated(rates({"cos(t)"}), start({0}), 2, 20);
  CHECK(std::abs(end.ode[0] - std::sin(2.0)) < 2e-13);
}

TEST_CASE("ode variables see each other", "[unit]") {
  const Instant end = integrated(rates({"b", "-a"}), start({0, 1}), 10, 100);
  CHECK(std::abs(end.ode[0] - std::sin(10.0)) < 1e-12);  // 100 steps of 1e-15
  CHECK(std::abs(end.ode[1] - std::cos(10.0)) < 8e-13);
}

TEST_CASE("a rate that jumps is integrated to a part in 4096 of the step", "[unit]") {
  const Instant end = integrated(rates({"t < 0.3 ? 1 : 0"}), start({0}), 1, 1);
  CHECK(std::abs(end.ode[0] - 0.3) < 1.0 / 4096);
}

TEST_CASE("the free drop has the tabulated semi-axes and rates", "[unit]") {
  // shared reference solution of the ellipse with A0 = R = 1: t, a, A.
  const auto [time, a, rate] = GENERATE(table<double, double, double>(
      {{0.5, 1.594763, 0.825283}, {1.0, 2.275516, 0.610216}, {1.5, 2.974855, 0.472383}, {2.0, 3.678985, 0.383358}}));
  CAPTURE(time);
  const Scene scene = scene_run::read(scene_run::scene_of_file("elliptical_drop.json"));
  World world;
  seed_world(scene, "elliptical_drop.json", world);
  const auto& equations = world.resource<ode::Equations>();
  REQUIRE(equations.name == std::vector<std::string>{"A", "a", "b"});
  const Instant end = integrated(equations.rate, scene.start, time, 100);
  const double A = end.ode[0];
  CHECK(std::abs(end.ode[1] - a) < 1e-6);  // the table has six digits
  CHECK(std::abs(A - rate) < 7e-7);
  // 2.4e-13 measured, in 100 steps.
  CHECK(std::abs(A * A * (std::pow(end.ode[1], 2) + std::pow(end.ode[2], 2)) - 2) < 2e-12);
}

TEST_CASE("a step carries the ode variables to the balances and to its end", "[unit]") {
  World world;
  world.resource<Clock>() = {.time = 0, .step = 0.5, .end_of_step = 0.5, .index = 0};
  world.resource<Rates>().time = 0.25;
  world.resource<ode::Equations>() = {{"a"}, rates({"a"})};
  static_cast<Instant&>(world.resource<ode::Values>()) = start({1});
  run<IntegrateOde<2>>(world);
  CHECK(world.resource<ode::AtBalances>().time == 0.25);
  CHECK(std::abs(world.resource<ode::AtBalances>().ode[0] - std::exp(0.25)) < 2e-14);
  CHECK(world.resource<ode::Values>().time == 0.5);
  CHECK(std::abs(world.resource<ode::Values>().ode[0] - std::exp(0.5)) < 6e-14);
}

TEST_CASE("an ode variable that becomes infinite ends the run and keeps its last value", "[error]") {
  World world;
  world.resource<Clock>() = {.time = 0, .step = 3, .end_of_step = 3, .index = 0};
  world.resource<Rates>().time = 3;
  world.resource<ode::Equations>() = {{"a"}, rates({"a^2"})};
  static_cast<Instant&>(world.resource<ode::Values>()) = start({1});
  CHECK_THROWS_WITH(run<IntegrateOde<2>>(world),
                    Catch::StartsWith("ode variable a is ") && Catch::EndsWith(" at t = 3 s; its rate is a^2"));
  CHECK(world.resource<ode::Values>().ode[0] == 1);
  CHECK(world.resource<ode::Values>().time == 0);
}

TEST_CASE("a body force may be an ode variable", "[unit]") {
  SceneRun run(accelerated);
  run.step(10);
  // g = 1 + 2 t, which the midpoint rule integrates exactly: v_y = -t - t^2; 3e-15 measured.
  Largest worst;
  for (const Vec<2>& v : run.world().column<particle::Velocity<2>>()) {
    worst.add((v - Vec<2>(3, -0.11)).norm());
  }
  CHECK(worst.value() < 3e-14);
}

TEST_CASE("a body force in 3-D may use ode variables", "[unit]") {
  SceneRun run(scene_run::with(accelerated, {R"(/body_force=["0*x", "-g"])"}));
  run.step(10);
  Largest worst;
  for (const Vec<2>& v : run.world().column<particle::Velocity<2>>()) {
    worst.add((v - Vec<2>(3, -0.11)).norm());
  }
  CHECK(worst.value() < 3e-14);
}

TEST_CASE("an initial velocity and a shape see the start of the ode variables", "[unit]") {
  SceneRun run(
      scene_run::with(accelerated, {R"(/particles/0/shape={"where": "abs(x - g) < g/4 && abs(y - g) < g/4"})"}));
  CHECK(run.world().rows<Particles>() == 144);
  CHECK(run.world().column<particle::Velocity<2>>()[0] == Vec<2>(3, 0));
}

TEST_CASE("a step from the CFL number sees the ode variables in the body force", "[unit]") {
  const Json scene = scene_run::with(accelerated, {R"(/time={"end": 1, "cfl": 0.5})", "/particles/0/velocity=[0, 0]",
                                                   R"(/quadrature={"scheme": "mixed"})"});
  const Scene read = scene_run::read(scene);
  World world;
  seed_world(read, "scene.json", world);
  const auto choose = make_time_plan(read).choose_step;
  CHECK(std::abs(choose(world) - std::min(read.output.every, std::sqrt(0.5 * 0.125 / 1))) < 1e-15);
  world.resource<ode::Values>().ode[0] = 1000;
  CHECK(std::abs(choose(world) - std::sqrt(0.5 * 0.125 / 1000)) < 1e-15);
}

TEST_CASE("a scene without ode block has neither its systems nor its components", "[unit]") {
  Json scene = scene_run::with(accelerated, {"/body_force=[0, -1]", "/particles/0/velocity=[0, 0]"});
  scene.erase("ode");
  const auto names = scene_run::step_names(scene);
  CHECK(std::none_of(names.begin(), names.end(), [](const std::string& n) { return n.ends_with("ode"); }));
  SceneRun run(scene);
  CHECK_FALSE(run.world().has<ode::Values>());
  CHECK_FALSE(run.world().has<ode::Equations>());
  CHECK_FALSE(run.world().has<ode::AtBalances>());
}

TEST_CASE("the checkpoint has the ode variables", "[unit]") {
  SceneRun run(accelerated);
  run.step();
  const auto columns = scene_run::state(run.world());
  REQUIRE(columns.contains("ode.values"));
  CHECK(columns.at("ode.values").size() == sizeof(Instant));
}
