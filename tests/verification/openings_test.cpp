/// \file
/// Liquid that comes in and leaves through openings: against exact streams, lattices and balances.

#include "support/extremes.hpp"
#include "support/mirror.hpp"
#include "support/scene_run.hpp"

#include "components/measure.hpp"
#include "components/openings.hpp"
#include "systems/openings/particles.hpp"
#include "systems/step/time_plan.hpp"

#include <catch2/catch.hpp>

#include <spdlog/fmt/fmt.h>

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A uniform stream through all sides of a box that is full of it.
template <int Dim>
Json stream(const Vec<Dim>& w, double step, int per_cell) {
  Json scene{
      {"dimension", Dim}, {"fluid", {{"density", 1000}, {"viscosity", 0}}}, {"time", {{"end", 9}, {"step", step}}}};
  std::vector<double> low(Dim, 0.0);
  std::vector<double> high(Dim, 0.5);
  std::vector<int> cells(Dim, 6);
  high[0] = 1;
  cells[0] = 12;
  scene["grid"] = {{"low", low}, {"high", high}, {"cells", cells}};
  std::vector<std::string> velocity;
  for (int d = 0; d < Dim; ++d) velocity.push_back(fmt::format("{}", w[d]));
  scene["particles"] = {
      {{"shape", {{"box", {{"low", low}, {"high", high}}}}}, {"per_cell", per_cell}, {"velocity", velocity}}};
  scene["openings"] = Json::array();
  for (int d = 0; d < Dim; ++d) {
    if (w[d] == 0) continue;
    const char axis = "xyz"[d];
    scene["openings"].push_back({{"name", fmt::format("in_{}", axis)},
                                 {"side", fmt::format("{}_{}", axis, w[d] > 0 ? "low" : "high")},
                                 {"inflow", {{"velocity", velocity}, {"per_cell", per_cell}}}});
    scene["openings"].push_back({{"name", fmt::format("out_{}", axis)},
                                 {"side", fmt::format("{}_{}", axis, w[d] > 0 ? "high" : "low")},
                                 {"outflow", "free"}});
  }
  return scene;
}

/// What a stream keeps: every particle its velocity, the box its fill.
template <int Dim>
void check_stream(const Json& json, const Vec<Dim>& w, int steps) {
  SceneRun run(json);
  run.start();
  World& world = run.world();
  const std::size_t count = world.rows<Particles>();
  Largest off;
  Largest unfilled;
  for (int k = 0; k < steps; ++k) {
    run.step();
    REQUIRE(world.rows<Particles>() == count);
    for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) off.add((v - w).norm());
    for (std::size_t l = 0; l < world.rows<Staggered>(); ++l) {
      if (world.column<multiplier::Capacity>()[l] > 0)
        unfilled.add(std::abs(world.column<multiplier::FillFraction>()[l] - 1));
    }
  }
  // Rounding of a few hundred operations a step.
  CHECK(off.value() < 1e-12);
  CHECK(unfilled.value() < 5e-3);
}

}  // namespace

TEST_CASE("a uniform stream through the box keeps velocity and density at any angle and step", "[verification]") {
  // Half a cell a step and less, and more than two cells.
  const double step = GENERATE(0.0137, 0.003, 0.19);
  const int per_cell = GENERATE(2, 3);
  const Vec<2> w = GENERATE(Vec<2>(0.8, 0.5), Vec<2>(-1, 0.013), Vec<2>(0.3, -0.9), Vec<2>(1, 0));
  CAPTURE(step, per_cell, w);
  check_stream<2>(stream<2>(w, step, per_cell), w, 40);
}

TEST_CASE("a uniform stream through the sides of a box in 3-D keeps velocity and density", "[verification]") {
  const double step = GENERATE(0.0137, 0.17);
  const Vec<3> w = GENERATE(Vec<3>(0.8, 0.5, -0.3), Vec<3>(-0.4, 0, 0.7));
  CAPTURE(step, w);
  check_stream<3>(stream<3>(w, step, 2), w, 25);
}

TEST_CASE("a uniform stream passes with every transfer scheme and quadrature, and with friction", "[verification]") {
  const std::string transfer = GENERATE("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm");
  const std::string quadrature = GENERATE("mixed", "particles");
  // None, at the start of the step, in the balances.
  const std::string viscosity = GENERATE("0", "1", "1000");
  CAPTURE(transfer, quadrature, viscosity);
  const Vec<2> w(0.8, -0.5);
  const Json scene =
      with(stream<2>(w, 0.021, 2), {R"(/transfer={"scheme": ")" + transfer + "\"}", "/fluid/viscosity=" + viscosity,
                                    R"(/quadrature={"scheme": ")" + quadrature + "\"}"});
  check_stream<2>(scene, w, 10);
}

TEST_CASE("the energy that came in through an opening is that of the particles that passed it", "[verification]") {
  const Vec<2> w(0.8, 0.5);
  SceneRun run(stream<2>(w, 0.0137, 2));
  run.start();
  run.step(40);
  const auto& columns = run.world().resource<measure::Columns>();
  for (const std::string name : {"in_x", "out_x", "in_y", "out_y"}) {
    CAPTURE(name);
    REQUIRE(columns.find(name + "_energy_in"));
    const double mass = *columns.find(name + "_mass_in");
    REQUIRE(std::abs(mass) > 1);
    // A pressure that is rounding does no work.
    CHECK(*columns.find(name + "_energy_in") == Approx(0.5 * w.squaredNorm() * mass).epsilon(1e-10));
  }
}

TEST_CASE("mass that came in is the mass that there is more", "[verification]") {
  // A jet at an angle, which changes, into an empty box with a wall to hit and two ways out.
  const Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]}, "fluid": {"density": 1000, "viscosity": 1},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.2]}}}],
    "openings": [
      {"name": "jet", "side": "x_low", "where": "y > 0.5 && y < 0.73",
       "inflow": {"velocity": ["1.5 + sin(9*t)", "cos(7*t)"], "per_cell": 3}},
      {"name": "drain", "side": "y_low", "where": "x > 0.8", "outflow": "free"},
      {"name": "spout", "side": "x_high", "where": "y < 0.3", "outflow": {"level": 0.15}}],
    "time": {"end": 1, "step": 5e-3}})json");
  SceneRun run(scene);
  run.start();
  World& world = run.world();
  const double before = total_mass(world);
  for (int k = 0; k < 150; ++k) {
    run.step();
    double came_in = 0;
    for (const double mass : world.column<opening::MassIn>()) came_in += mass;
    // Sums of a few thousand particles.
    REQUIRE(std::abs(total_mass(world) - before - came_in) < 1e-12 * before);
  }
  // Something has passed every opening.
  for (const double mass : world.column<opening::MassIn>()) CHECK(std::abs(mass) > 1);
}

namespace {

/// A jet at an angle, which changes, into a basin with a way out, through which liquid may also come back.
Json basin() {
  return Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]}, "fluid": {"density": 1000, "viscosity": 1},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.3]}}}],
    "openings": [
      {"name": "jet", "side": "x_low", "where": "y > 0.5 && y < 0.73",
       "inflow": {"velocity": ["1.5 + sin(9*t)", "cos(7*t)"], "per_cell": 3}},
      {"name": "spout", "side": "x_high", "outflow": {"level": 0.35}}],
    "time": {"end": 1, "step": 5e-3}})json");
}

}  // namespace

TEST_CASE("a step that is taken back leaves no particle behind", "[verification]") {
  SceneRun run(basin());
  run.start();
  run.step(20);
  const auto before = state(run.world());
  run.world().mark();
  run.step(1);
  const auto after = state(run.world());
  CHECK(before != after);
  run.world().roll_back();
  CHECK(state(run.world()) == before);
  run.step(1);
  CHECK(state(run.world()) == after);
}

TEST_CASE("what comes in has the same bits one system after the other and side by side", "[verification]") {
  SceneRun graph(basin(), Execution::graph);
  SceneRun serial(basin(), Execution::list);
  graph.start();
  serial.start();
  graph.step(40);
  serial.step(40);
  CHECK(state(graph.world()) == state(serial.world()));
}

TEST_CASE("particles carry in what the faces let in", "[verification]") {
  // A profile, and an opening whose edges lie within cells.
  const Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]}, "fluid": {"density": 1000, "viscosity": 0},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.2, 1]}}}],
    "openings": [
      {"name": "in", "side": "x_low", "where": "y > 0.21 && y < 0.78",
       "inflow": {"velocity": ["1 + 3*y*(1 - y)", "0"]}},
      {"name": "out", "side": "x_high", "outflow": "free"}],
    "time": {"end": 1, "step": 3e-3}})json");
  SceneRun run(scene);
  run.start();
  double through_faces = 0;
  for (int k = 0; k < 300; ++k) {
    run.step();
    through_faces += 3e-3 * *run.world().resource<measure::Columns>().find("in_rate");
  }
  const double carried = run.world().column<opening::MassIn>()[0] / 1000;
  // int_0.21^0.78 (1 + 3 y (1 - y)) dy, with edges to 1/32 of a face; columns are whole particles, of 6.25e-4 each.
  const auto primitive = [](double y) { return y + 1.5 * y * y - y * y * y; };
  CHECK(through_faces == Approx(0.9 * (primitive(0.78) - primitive(0.21))).epsilon(4e-3));
  CHECK(std::abs(carried - through_faces) < 26 * 6.25e-4);
}

TEST_CASE("the rate of an inflow is its flow, whatever its place", "[verification]") {
  const std::string where = GENERATE("1", "y > 0.33 && y < 0.61");
  CAPTURE(where);
  Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [16, 16]}, "fluid": {"density": 1000, "viscosity": 0},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.7]}}}],
    "openings": [{"name": "river", "side": "x_low", "inflow": {"rate": "0.2 + 0.1*t", "level": "0.7"}}],
    "time": {"end": 1, "step": 5e-3}})json");
  scene["openings"][0]["where"] = where;
  SceneRun run(scene);
  run.start();
  run.step(20);
  // In the balances of the last step, at 0.0975 s.
  CHECK(*run.world().resource<measure::Columns>().find("river_rate") == Approx(0.2 + 0.1 * 0.0975).epsilon(1e-12));
}

TEST_CASE("the rate of an inflow is its flow, however bodies cut it", "[verification]") {
  // A channel between two bodies, whose surfaces lie on faces of the grid, or half a cell further in; full of liquid.
  const double cut = GENERATE(0.0, 0.5, 0.3);
  CAPTURE(cut);
  Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [2, 1], "cells": [32, 16]}, "fluid": {"density": 1000, "viscosity": 0},
    "openings": [{"name": "inlet", "side": "x_low", "inflow": {"rate": 0.1}},
                 {"name": "outlet", "side": "x_high", "outflow": "free"}],
    "time": {"end": 9, "step": 5e-3}})json");
  const double low = (4 + cut) / 16;
  const double high = (12 - cut) / 16;
  scene["particles"] = {{{"shape", {{"box", {{"low", {0, low}}, {"high", {2, high}}}}}}}};
  scene["bodies"] = {{{"name", "below"}, {"shape", {{"box", {{"low", {-1, -1}}, {"high", {3, low}}}}}}},
                     {{"name", "above"}, {"shape", {{"box", {{"low", {-1, high}}, {"high", {3, 2}}}}}}}};
  SceneRun run(scene);
  run.step(60);
  CHECK(measured(run.world(), "inlet_rate") == Approx(0.1).epsilon(1e-9));
  CHECK(measured(run.world(), "outlet_rate") == Approx(-0.1).epsilon(1e-9));
  // The liquid in the middle, too: 0.94 of it when both the inlet's share and the grid's took off what a body covers.
  double sum = 0;
  double mass = 0;
  const auto x = run.world().column<particle::Position<2>>();
  for (std::size_t p = 0; p < x.size(); ++p) {
    if (x[p][0] < 0.5 || x[p][0] > 1.5) continue;
    sum += run.world().column<particle::Mass>()[p] * run.world().column<particle::Velocity<2>>()[p][0];
    mass += run.world().column<particle::Mass>()[p];
  }
  CHECK(sum / mass == Approx(0.1 / (high - low)).epsilon(0.01));
}

TEST_CASE("what comes in may leave with a piston", "[verification]") {
  // A full tank: the piston makes as much room as comes in.
  SceneRun run(Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [2, 1], "cells": [16, 8]}, "fluid": {"density": 1000, "viscosity": 0},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1.5, 1]}}}],
    "bodies": [{"name": "piston", "shape": {"box": {"low": [1.5, -1], "high": [3, 2]}},
                "motion": {"prescribed": {"velocity": ["0.1", "0"]}}}],
    "openings": [{"name": "inlet", "side": "x_low", "inflow": {"velocity": ["v", "0"]}}],
    "constants": {"v": 0.1}, "time": {"end": 9, "step": 0.01}})json"));
  run.step(50);
  const auto v = run.world().column<particle::Velocity<2>>();
  for (const Vec<2>& of : v) REQUIRE((of - Vec<2>(0.1, 0)).norm() < 1e-3);
}

TEST_CASE("what comes in faster than a piston leaves is told", "[verification]") {
  Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [2, 1], "cells": [16, 8]}, "fluid": {"density": 1000, "viscosity": 0},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1.5, 1]}}}],
    "bodies": [{"name": "piston", "shape": {"box": {"low": [1.5, -1], "high": [3, 2]}},
                "motion": {"prescribed": {"velocity": ["0.1", "0"]}}}],
    "openings": [{"name": "inlet", "side": "x_low", "inflow": {"velocity": ["0.2", "0"]}}],
    "time": {"end": 9, "step": 0.01}})json");
  SceneRun run(scene);
  CHECK_THROWS_WITH(run.step(), Catch::Contains("they and what comes in squeeze liquid"));
}

TEST_CASE("what a wave maker pushes in it draws out again", "[verification]") {
  const Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 0.6], "cells": [20, 12]}, "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.3]}}}],
    "openings": [
      {"name": "maker", "side": "x_low", "where": "y < 0.3", "inflow": {"velocity": ["0.2*sin(2*pi*t)", "0"]}}],
    "time": {"end": 9, "step": 5e-3}})json");
  SceneRun run(scene);
  run.start();
  const auto& mass_in = run.world().column<opening::MassIn>();
  run.step(100);
  // Water 0.3 m deep moves by 0.2/pi m and back, to a few particles of 0.28 kg.
  CHECK(mass_in[0] == Approx(60 / 3.141592653589793).margin(1.8));
  run.step(100);
  CHECK(std::abs(mass_in[0]) < 1.6);
}

TEST_CASE("plane Poiseuille flow comes in and leaves", "[verification][long]") {
  const Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [2, 1], "cells": [32, 16]}, "walls": {"x": "slip", "y": "no_slip"},
    "fluid": {"density": 1, "viscosity": 0.05},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [2, 1]}}, "velocity": ["6*y*(1-y)", "0"]}],
    "openings": [
      {"name": "in", "side": "x_low", "inflow": {"velocity": ["6*y*(1-y)", "0"]}},
      {"name": "out", "side": "x_high", "outflow": "free"}],
    "time": {"end": 9, "step": 0.02}})json");
  SceneRun run(scene);
  run.start();
  run.step(200);
  World& world = run.world();
  CHECK(*world.resource<measure::Columns>().find("in_rate") == Approx(1).epsilon(1e-10));
  CHECK(*world.resource<measure::Columns>().find("out_rate") == Approx(-1).epsilon(1e-10));
  double error = 0;
  double size = 0;
  const auto x = world.column<particle::Position<2>>();
  const auto v = world.column<particle::Velocity<2>>();
  for (std::size_t p = 0; p < x.size(); ++p) {
    const Vec<2> exact(6 * x[p][1] * (1 - x[p][1]), 0);
    error += (v[p] - exact).squaredNorm();
    size += exact.squaredNorm();
  }
  CHECK(std::sqrt(error / size) < 0.015);  // 0.007 with 64 x 16 cells
  // The pressure that drives it, 12 mu U/H^2 = 0.6 per length, is what inflow pushes with: 1.2 W over 2 m.
  const double before = world.column<opening::EnergyIn>()[0] + world.column<opening::EnergyIn>()[1];
  run.step(100);
  const double after = world.column<opening::EnergyIn>()[0] + world.column<opening::EnergyIn>()[1];
  CHECK((after - before) / 2 == Approx(1.2).epsilon(0.03));
}

TEST_CASE("liquid between openings at its level stays at rest", "[verification]") {
  const Json scene = Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [16, 16]}, "fluid": {"density": 1000, "viscosity": 1e-3},
    "body_force": [0, -9.81], "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}}],
    "openings": [
      {"name": "left", "side": "x_low", "inflow": {"level": "0.5"}},
      {"name": "right", "side": "x_high", "outflow": {"level": 0.5}}],
    "time": {"end": 9, "step": 5e-3}})json");
  SceneRun run(scene);
  run.start();
  double most = 0;
  for (int k = 0; k < 300; ++k) {
    run.step();
    most = largest_of(most, run.world().resource<measure::MaxSpeed>().value);
  }
  // Of sqrt(2 g 0.5 m) = 3.1 m/s; 0.05 where the surface lies within a row of faces.
  CHECK(most < 0.1);
}

namespace {

/// Plane Poiseuille flow at its speed, 1 m high, between pressures of 2 Pa and 0 over 2 m: U = 1/(12 mu).
Json pressure_channel(int dimension, double viscosity) {
  Json scene = Json::parse(R"json({
    "grid": {"low": [0, 0], "high": [2, 1], "cells": [20, 10]}, "walls": {"x": "slip", "y": "no_slip"},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [2, 1]}}, "velocity": ["0.5*y*(1 - y)/mu", 0]}],
    "openings": [{"name": "in", "side": "x_low", "outflow": {"pressure": 2}},
                 {"name": "out", "side": "x_high", "outflow": {"pressure": 0}}],
    "time": {"end": 99, "step": 0.25}})json");
  scene["dimension"] = dimension;
  scene["fluid"] = {{"density", 100}, {"viscosity", viscosity}};
  scene["constants"] = {{"mu", viscosity}};
  if (dimension == 2) return scene;
  scene["walls"]["z"] = "periodic";
  scene["grid"]["low"].push_back(0);
  scene["grid"]["high"].push_back(0.5);
  scene["grid"]["cells"].push_back(5);
  Json& region = scene["particles"][0];
  region["shape"]["box"]["low"].push_back(0);
  region["shape"]["box"]["high"].push_back(0.5);
  region["velocity"].push_back(0);
  region["per_cell"] = 2;
  return scene;
}

/// Flow through the opening "in" over the exact one after some steps.
double share_of_flow(const Json& scene, int steps) {
  SceneRun run(scene);
  run.step(steps);
  const double area = scene["dimension"] == 2 ? 1 : 0.5;
  return measured(run.world(), "in_rate") * 12 * scene["fluid"]["viscosity"].get<double>() / area;
}

Json with_static_pressures(Json scene) {
  for (Json& opening : scene["openings"]) opening["outflow"]["kind"] = "static";
  return scene;
}

}  // namespace

TEST_CASE("static pressures drive plane Poiseuille flow whatever its Reynolds number", "[verification]") {
  // Re = 0.08 and 8. Between reservoirs the flow at Re = 8 is 0.85 of that after 10 s, 0.8 later, because the liquid
  // has to be brought to its speed.
  const double viscosity = GENERATE(10.0, 1.0);
  const Mirror<2> mirror =
      GENERATE(Mirror<2>{{0, 1}, {false, false}}, Mirror<2>{{0, 1}, {true, false}}, Mirror<2>{{1, 0}, {false, true}});
  CAPTURE(viscosity, mirror.axis, mirror.mirrored);
  const Json scene = mirrored<2>(pressure_channel(2, viscosity), mirror);
  CHECK(share_of_flow(with_static_pressures(scene), 40) == Approx(1).epsilon(0.02));  // 0.990 measured, of both
  CHECK(share_of_flow(scene, 40) < (viscosity > 1 ? 0.99 : 0.86));
}

TEST_CASE("static pressures drive plane Poiseuille flow in 3-D", "[verification]") {
  const Json scene = pressure_channel(3, 1);
  CHECK(share_of_flow(with_static_pressures(scene), 20) == Approx(1).epsilon(0.02));
}

TEMPLATE_TEST_CASE_SIG("what comes in under a pressure brings the shear of the flow", "[verification]",
                       ((int Dim), Dim), 2, 3) {
  SceneRun run(with_static_pressures(pressure_channel(Dim, 1)));
  double largest = 0;
  for (int step = 0; step < 12; ++step) {
    run.step();
    for (const Mat<Dim>& gradient : run.world().resource<opening::Arrivals<Dim>>().velocity_gradient) {
      largest = largest_of(largest, std::abs(gradient(0, 1)));
      Mat<Dim> others = gradient;
      others(0, 1) = 0;
      CHECK(others.cwiseAbs().maxCoeff() < 1e-3);
    }
  }
  // 0.5/s at the walls. The columns nearest to them, 3 or 2 in a cell of 0.1 m, are one or one and a half spacings away
  // from the point where their difference is the profile's slope.
  CHECK(largest == Approx(Dim == 2 ? 0.5 - 0.1 / 3 : 0.45).epsilon(0.05));
}

TEST_CASE("inflow without a way out is told", "[verification]") {
  Json scene = stream<2>(Vec<2>(1, 0), 0.01, 2);
  scene["openings"].erase(1);
  SceneRun run(scene);
  run.start();
  CHECK_THROWS_WITH(run.step(), Catch::Contains("without a way out"));
}

namespace {

/// A packet of waves, 1 m long, that runs along a channel of 0.25 m from its low end.
Json packet(double length) {
  Json scene = Json::parse(R"json({"dimension": 2, "grid": {"low": [0, 0]},
    "fluid": {"density": 1000, "viscosity": 0}, "body_force": [0, -9.81],
    "particles": [{"shape": {"where": "y < 0.25 + 0.03*exp(-(x/0.9)^2)*cos(2*pi*x)"}, "per_cell": 4}],
    "probes": [{"name": "water", "at": [1, 0.15]}], "time": {"end": 9, "step": 8e-3}})json");
  scene["grid"]["high"] = {length, 0.4};
  scene["grid"]["cells"] = {static_cast<int>(20 * length), 8};
  return scene;
}

/// Velocity along the channel at 1 m, after every step.
std::vector<double> velocities(const Json& scene) {
  SceneRun run(scene);
  run.start();
  std::vector<double> velocities;
  for (int k = 0; k < 1125; ++k) {
    run.step();
    velocities.push_back(*run.world().resource<measure::Columns>().find("water_velocity_x"));
  }
  return velocities;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  Largest largest;
  for (std::size_t k = 0; k < a.size(); ++k) largest.add(std::abs(a[k] - b[k]));
  return largest.value();
}

}  // namespace

TEST_CASE("a sponge reflects less than a twentieth of a wave", "[verification][long]") {
  // What comes back from the end within 9 s is what a channel twice as long does not have yet.
  const std::vector<double> endless = velocities(packet(8));
  Json with_sponge = packet(4);
  with_sponge["sponge"] = {{{"where", "x > 2"}, {"rate", "2*(x - 2)"}}};
  const double by_wall = largest_difference(velocities(packet(4)), endless);
  const double by_sponge = largest_difference(velocities(with_sponge), endless);
  CAPTURE(by_wall, by_sponge);
  CHECK(by_wall > 0.04);  // of 0.07 m/s that went by
  CHECK(by_sponge < 0.05 * by_wall);
}

namespace {

/// A tap over an empty box of 1 m with a drain; it runs up to a time and from a later one on.
template <int Dim>
Json empty_box(double until, double again) {
  const std::string velocity = fmt::format("-0.5*(t < {} || t > {})", until, again);
  const std::size_t up = Dim - 1;
  std::vector<double> gravity(Dim, 0);
  gravity[up] = -9.81;
  std::vector<Json> inflow(Dim, 0);
  inflow[up] = velocity;
  Json scene{{"dimension", Dim},
             {"grid",
              {{"low", std::vector<double>(Dim, 0)},
               {"high", std::vector<double>(Dim, 1)},
               {"cells", std::vector<int>(Dim, 10)}}},
             {"fluid", {{"density", 1000}, {"viscosity", 1e-3}}},
             {"body_force", gravity},
             {"time", {{"end", 9}, {"step", 0.02}}}};
  scene["openings"] = {{{"name", "tap"},
                        {"side", fmt::format("{}_high", "xyz"[up])},
                        {"where", "abs(x - 0.5) < 0.2"},
                        {"inflow", {{"velocity", inflow}}}},
                       {{"name", "drain"}, {"side", fmt::format("{}_low", "xyz"[up])}, {"outflow", "free"}}};
  return scene;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("an empty box is filled through a tap", "[verification]", ((int Dim), Dim), 2, 3) {
  Json scene = empty_box<Dim>(100, 200);
  scene["openings"].erase(1);
  std::vector<double> corner(Dim, 0.0);
  scene["gauges"] = {{{"name", "level"}, {"at", corner}}};
  SceneRun run(scene);
  run.start();
  CHECK(run.world().template rows<Particles>() == 0);
  CHECK(measured(run.world(), "level") == 0);
  const double seconds = 1.2;
  Largest overlap;
  for (int k = 0; k < 60; ++k) {
    run.step();
    overlap.add(run.world().template resource<measure::Overlap>().value);
  }
  // A tap of 0.4 m, or 0.4 x 1 m, without the row of particles that is about to come in.
  CHECK(measured(run.world(), "tap_mass_in") / 1000 == Approx(0.4 * 0.5 * seconds).margin(0.4 / 30));
  Largest above;
  for (const Vec<Dim>& x : run.world().template column<particle::Position<Dim>>()) above.add(x[Dim - 1]);
  CHECK(above.value() <= 1);
  CHECK(overlap.value() < 0.1);
}

TEST_CASE("a box runs dry and is filled again", "[verification]") {
  Json scene = empty_box<2>(0, 1.5);
  scene["particles"] = {{{"shape", {{"ball", {{"center", {0.4, 0.4}}, {"radius", 0.2}}}}}}};
  SceneRun run(scene);
  run.start();
  const double mass = total_mass(run.world());
  run.step(70);
  CHECK(run.world().rows<Particles>() == 0);
  CHECK(measured(run.world(), "drain_mass_in") == Approx(-mass));
  CHECK(run.world().resource<measure::Overlap>().value == 0);
  run.step(30);
  CHECK(run.world().rows<Particles>() > 0);
  CHECK(measured(run.world(), "tap_mass_in") == Approx(total_mass(run.world())));
}

TEST_CASE("the first step of an empty box is as long as what comes in allows", "[verification]") {
  Json scene = empty_box<2>(100, 200);
  SceneRun run(scene);
  run.start();
  scene["time"] = {{"end", 9}, {"cfl", 1}};
  scene["output"] = {{"every", 1}};
  const double step = make_time_plan(read(scene)).choose_step(run.world());
  // (w + |b| dt) dt = h.
  CHECK((0.5 + 9.81 * step) * step == Approx(0.1).epsilon(1e-9));
}
