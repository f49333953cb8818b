#include "support/extremes.hpp"
#include "support/kernels.hpp"

#include "components/step.hpp"
#include "support/scene_run.hpp"
#include "systems/time/body_force.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;
using scene_run::SceneRun;

namespace {

void set_force(World& world, const std::string& x, const std::string& y, double time) {
  const ExpressionScope scope = scene_scope({{"g", 9.81}});
  world.resource<BodyForce>().of_place_and_time = {Expression(x, scope), Expression(y, scope)};
  world.resource<Rates>().time = time;
}

const Json falling = Json::parse(R"json({
  "dimension": 2, "constants": {"g": 2}, "grid": {"low": [0, 0], "high": [2, 2], "cells": [16, 16]},
  "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, "-g*t"],
  "particles": [{"shape": {"box": {"low": [0.75, 0.75], "high": [1.25, 1.25]}}}],
  "integrator": {"scheme": "midpoint"}, "time": {"end": 1, "step": 0.01}})json");

}  // namespace

TEST_CASE("a uniform body force is the same at all nodes with mass", "[unit]") {
  World world;
  fill<2>(world, 40, 51);
  set_force(world, "3*t", "-g", 2);
  run<UniformBodyForce<2>>(world);
  const auto m_i = world.column<node::Mass>();
  const auto b_i = world.column<node::BodyForce<2>>();
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < m_i.size(); ++i) wrong += b_i[i] != (m_i[i] > 0 ? Vec<2>(6, -9.81) : Vec<2>(0, 0));
  CHECK(wrong == 0);
}

TEST_CASE("a body force in 3-D is sampled at the particles at the time of the balance", "[unit]") {
  World world;
  fill<2>(world, 40, 52);
  set_force(world, "x*t", "y - g", 2);
  run<SampleBodyForce<2>>(world);
  const auto y_p = world.column<particle::QuadraturePosition<2>>();
  const auto b_p = world.column<particle::BodyForce<2>>();
  Largest worst;
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    worst.add((b_p[p] - Vec<2>(2 * y_p[p][0], y_p[p][1] - 9.81)).norm());
  }
  CHECK(worst.value() < 2e-15);  // a rounding of numbers of size 10
}

TEST_CASE("the nodal body force keeps the total force of the particles", "[unit]") {
  World world;
  fill<2>(world, 40, 53);
  set_force(world, "x*y", "y - g", 0);
  run<SampleBodyForce<2>>(world);
  run<P2GBodyForce<2>>(world);
  Vec<2> of_particles = Vec<2>::Zero();
  Vec<2> of_nodes = Vec<2>::Zero();
  for (std::size_t p = 0; p < 40; ++p) {
    of_particles += world.column<particle::Mass>()[p] * world.column<particle::BodyForce<2>>()[p];
  }
  for (std::size_t i = 0; i < world.rows<Nodes>(); ++i) {
    of_nodes += world.column<node::Mass>()[i] * world.column<node::BodyForce<2>>()[i];
  }
  CHECK((of_particles - of_nodes).norm() < 7e-13);  // a rounding of sums of size 400
}

TEST_CASE("the pipeline samples a body force only if it varies in space", "[unit]") {
  const Json on_nodes = scene_run::of_equal_order(falling);
  const auto uniform = scene_run::step_names(on_nodes);
  CHECK(std::count(uniform.begin(), uniform.end(), "uniform_body_force") == 1);
  CHECK(std::count(uniform.begin(), uniform.end(), "sample_body_force") == 0);
  const Json varying = scene_run::with(on_nodes, {R"(/body_force=["x", 0])"});
  const auto sampled = scene_run::step_names(varying);
  CHECK(std::count(sampled.begin(), sampled.end(), "uniform_body_force") == 0);
  CHECK(std::count(sampled.begin(), sampled.end(), "sample_body_force") == 1);
}

TEST_CASE("a force that grows with time drives by its value at mid-step", "[unit]") {
  SceneRun run(falling);
  run.step(10);
  // v = -g t^2/2: the midpoint rule integrates a linear force exactly; 7e-18 measured.
  Largest worst;
  for (const Vec<2>& v : run.world().column<particle::Velocity<2>>()) {
    worst.add((v - Vec<2>(0, -0.01)).norm());
  }
  CHECK(worst.value() < 7e-17);
}
