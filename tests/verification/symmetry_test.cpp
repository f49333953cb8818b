#include "support/extremes.hpp"
#include "support/scenes.hpp"

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A column that collapses in a box of 16 x 12 cells from the left, with an inner motion.
Json collapse() {
  return paper(Json::parse(R"json({
    "dimension": 2, "grid": {"low": [-1, 0], "high": [1, 1.5], "cells": [16, 12]},
    "fluid": {"density": 1000, "viscosity": 0.1}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [-1, 0], "high": [-0.25, 1]}}, "per_cell": 2,
                   "velocity": ["0.3*sin(2*y)", "0.1*x"]}],
    "time": {"end": 1, "step": 0.004}})json"));
}

/// The same from the right.
Json mirrored() {
  return with(collapse(), {R"(/particles/0/shape={"box": {"low": [0.25, 0], "high": [1, 1]}})",
                           R"json(/particles/0/velocity=["-0.3*sin(2*y)", "-0.1*x"])json"});
}

/// A square that turns and strains in a large box.
Json turning(double speed) {
  Json scene = paper(Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [8, 4], "cells": [64, 32]},
    "fluid": {"density": 1000, "viscosity": 1},
    "particles": [{"shape": {"box": {"low": [1.5, 1.5], "high": [2.5, 2.5]}}, "per_cell": 2}],
    "time": {"end": 2, "step": 0.0625}})json"));
  scene["particles"][0]["velocity"] = {std::to_string(speed) + " - 0.5*(y - 2)", "0.5*(x - 2)*(1 + x - 2)"};
  return scene;
}

/// turning(0) between periodic ends, in the middle of the box, or with the ends in its middle.
Json periodic(bool across_the_ends) {
  Json scene = turning(0);
  scene["walls"] = {{"x", "periodic"}, {"y", "slip"}};
  if (!across_the_ends) return scene;
  const Json velocity = {"-0.5*(y - 2)", "0.5*(x < 4 ? x : x - 8)*(1 + (x < 4 ? x : x - 8))"};
  const auto part = [&](double low, double high) {
    return Json{
        {"shape", {{"box", {{"low", {low, 1.5}}, {"high", {high, 2.5}}}}}}, {"per_cell", 2}, {"velocity", velocity}};
  };
  scene["particles"] = Json::array({part(7.5, 8), part(0, 0.5)});
  return scene;
}

/// From b to a along the shortest way in the periodic box of 8 m.
Vec<2> way_round(const Vec<2>& a, const Vec<2>& b) {
  const Vec<2> way = a - b;
  return {std::remainder(way[0], 8), way[1]};
}

}  // namespace

TEST_CASE("a mirrored scene gives the mirrored result", "[verification][long]") {
  SceneRun left(any_method(collapse()));
  CAPTURE(left.scene().schemes);
  SceneRun right(with(mirrored(), {"/transfer=" + Json{{"scheme", left.scene().schemes.at("transfer")}}.dump(),
                                   "/integrator=" + Json{{"scheme", left.scene().schemes.at("integrator")}}.dump()}));
  left.step(40);
  right.step(40);
  // Who is whose mirror image: rows of the lattice run the other way.
  const auto x = by_id<particle::Position<2>>(left.world());
  const auto v = by_id<particle::Velocity<2>>(left.world());
  const auto x_mirrored = by_id<particle::Position<2>>(right.world());
  const auto v_mirrored = by_id<particle::Velocity<2>>(right.world());
  constexpr std::size_t across = 12;
  Largest worst_x;
  Largest worst_v;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const std::size_t q = p / across * across + across - 1 - p % across;
    worst_x.add((x[p] - Vec<2>(-x_mirrored[q][0], x_mirrored[q][1])).norm());
    worst_v.add((v[p] - Vec<2>(-v_mirrored[q][0], v_mirrored[q][1])).norm());
  }
  // Roundings of 1e-16 that 40 steps of a collapse let grow: 5e-16 and 5e-15 measured.
  CHECK(worst_x.value() < 5e-15);
  CHECK(worst_v.value() < 5e-14);
}

TEST_CASE("a flow does not know the uniform velocity on top of it", "[verification]") {
  const std::string transfer = GENERATE("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm");
  const std::string integrator = GENERATE("newmark", "midpoint");
  CAPTURE(transfer, integrator);
  // Four cells per step, two per half step: particles meet the grid in the same places. All numbers are dyadic.
  constexpr double speed = 4 * 0.125 / 0.0625;
  SceneRun at_rest(with_method(turning(0), transfer, integrator));
  SceneRun moving(with_method(turning(speed), transfer, integrator));
  constexpr int steps = 8;
  at_rest.step(steps);
  moving.step(steps);
  const Vec<2> way(speed * steps * 0.0625, 0);
  const auto x = by_id<particle::Position<2>>(at_rest.world());
  const auto x_moving = by_id<particle::Position<2>>(moving.world());
  Largest worst;
  for (std::size_t p = 0; p < x.size(); ++p) worst.add((x_moving[p] - way - x[p]).norm());
  // Roundings of 1e-15 at a speed of 8 m/s, over 8 steps: 6e-14 measured.
  CHECK(worst.value() < 5e-13);
}

TEST_CASE("a flow does not know where the ends of a periodic axis are", "[verification]") {
  const auto method = [transfer = GENERATE("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm"),
                       integrator = GENERATE("newmark", "midpoint")](const Json& scene) {
    return with_method(scene, transfer, integrator);
  };
  SceneRun inside(method(periodic(false)));
  SceneRun across(method(periodic(true)));
  const auto x_start = by_id<particle::Position<2>>(inside.world());
  const auto x_start_across = by_id<particle::Position<2>>(across.world());
  REQUIRE(x_start.size() == x_start_across.size());
  inside.step(8);
  across.step(8);
  const auto x = by_id<particle::Position<2>>(inside.world());
  const auto x_across = by_id<particle::Position<2>>(across.world());
  CAPTURE(inside.scene().schemes);
  const Vec<2> shift(2, 0);
  Largest worst;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const auto twin = std::find_if(x_start_across.begin(), x_start_across.end(), [&](const Vec<2>& start) {
      return way_round(x_start[p] - shift, start).norm() < 1e-9;
    });
    REQUIRE(twin != x_start_across.end());
    const auto q = static_cast<std::size_t>(twin - x_start_across.begin());
    worst.add(way_round(x[p] - shift, x_across[q]).norm());
  }
  // Roundings of 1e-15 of coordinates up to 8 m, over 8 steps: 3e-14 measured.
  CHECK(worst.value() < 3e-13);
}
