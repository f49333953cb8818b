/// \file
/// The balance of energy (E59): whatever does work on the liquid, energy that nothing gave is told, and no other.

#include "tools/program/summary.hpp"

#include "support/extremes.hpp"
#include "support/scene_run.hpp"

#include "components/energy_given.hpp"
#include "components/measure.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double told = 0.01;  ///< a run warns from here

/// (E59) after a number of steps.
double rise_after(const Json& scene, int steps) {
  SceneRun run(scene);
  run.step(steps);
  return energy_rise(run.world());
}

/// Water in the lower half of a box of 1 m, 12 cells a side, in 3-D 6.
template <int Dim>
Json half_full_box() {
  Json scene = Json::parse(R"({"fluid": {"density": 1000, "viscosity": 1e-3}, "transfer": {"scheme": "tpic"},
    "time": {"end": 10, "step": 0.01}})");
  const std::size_t up = Dim - 1;
  std::vector<double> surface(Dim, 1);
  surface[up] = 0.5;
  std::vector<double> gravity(Dim, 0);
  gravity[up] = -9.81;
  scene["dimension"] = Dim;
  scene["grid"] = {{"low", std::vector<double>(Dim, 0)},
                   {"high", std::vector<double>(Dim, 1)},
                   {"cells", std::vector<int>(Dim, Dim == 2 ? 12 : 6)}};
  scene["body_force"] = gravity;
  scene["particles"] = {{{"shape", {{"box", {{"low", std::vector<double>(Dim, 0)}, {"high", surface}}}}}}};
  return scene;
}

/// A drop with sigma = rho = 1, whole or cut off by the floor, in a box of 1 m.
template <int Dim>
Json drop(int cells, double radius, double height, double angle) {
  Json scene = Json::parse(R"({"walls": "slip", "fluid": {"density": 1, "viscosity": 0.02},
    "transfer": {"scheme": "tpic"}, "surface_tension": {"coefficient": 1}, "time": {"end": 10}, "particles": [
    {"arrangement": "cut", "per_cell": 3, "shape": {"intersection": [{"ball": {}}, {"box": {}}]}}]})");
  std::vector<double> centre(Dim, 0.5);
  centre[Dim - 1] = height;
  scene["dimension"] = Dim;
  scene["grid"] = {{"low", std::vector<double>(Dim, 0)},
                   {"high", std::vector<double>(Dim, 1)},
                   {"cells", std::vector<int>(Dim, cells)}};
  scene["surface_tension"]["contact_angle"] = angle;
  Json& parts = scene["particles"][0]["shape"]["intersection"];
  parts[0]["ball"]["center"] = centre;
  parts[0]["ball"]["radius"] = radius;
  parts[1]["box"]["low"] = scene["grid"]["low"];
  parts[1]["box"]["high"] = scene["grid"]["high"];
  const double h = 1.0 / cells;
  scene["time"]["step"] = 0.5 * std::sqrt(h * h * h / 6.3);
  return scene;
}

}  // namespace

TEST_CASE("a drop at rest gains no energy, however small next to its surface the energy of its currents",
          "[verification]") {
  const auto [cells, radius] = GENERATE(table<int, double>({{16, 0.25}, {16, 0.3}, {32, 0.25}}));
  CAPTURE(cells, radius);
  CHECK(rise_after(drop<2>(cells, radius, 0.5, 90), 100) < told);
}

TEST_CASE("a drop at rest in 3-D gains no energy", "[verification]") {
  CHECK(rise_after(drop<3>(16, 0.25, 0.5, 90), 20) < told);
}

TEST_CASE("a drop that spreads on a wall, or draws back, gains no energy", "[verification]") {
  const double angle = GENERATE(60.0, 120.0, 150.0);
  CAPTURE(angle);
  CHECK(rise_after(drop<2>(24, 0.25, 0, angle), 150) < told);
}

TEST_CASE("drops that merge and swing gain no energy", "[verification]") {
  Json scene = drop<2>(24, 0.15, 0.5, 90);
  Json other = scene["particles"][0];
  scene["particles"][0]["shape"]["intersection"][0]["ball"]["center"] = {0.34, 0.5};
  other["shape"]["intersection"][0]["ball"]["center"] = {0.64, 0.5};
  scene["particles"].push_back(other);
  CHECK(rise_after(scene, 150) < told);
}

TEST_CASE("a drop that steps beyond the capillary limit make unstable is told", "[verification]") {
  Json scene = drop<2>(24, 0.25, 0.5, 90);
  scene["fluid"]["viscosity"] = 0;
  scene["time"]["step"] = 12 * scene["time"]["step"].get<double>();
  CHECK(rise_after(scene, 5) > told);  // a sixth is taken back: a node moves by more than ten cells
}

TEMPLATE_TEST_CASE_SIG("forces in time and space give the energy that they bring, and no more", "[verification]",
                       ((int Dim), Dim), 2, 3) {
  const bool is_conforming = GENERATE(true, false);
  const std::string integrator = GENERATE("midpoint", "newmark");
  Json scene = half_full_box<Dim>();
  scene["integrator"] = {{"scheme", integrator}};
  if (!is_conforming) scene = of_equal_order(scene);
  const std::string force = GENERATE("2*sin(5*t)", "x*(y - 0.5)", "0.1");
  const bool is_periodic = force == "0.1";
  if (is_periodic) scene["walls"] = {{"x", "periodic"}};
  scene["body_force"][0] = force;
  CAPTURE(is_conforming, integrator, force);
  SceneRun run(scene);
  run.step(Dim == 2 ? 100 : 20);
  CHECK(energy_rise(run.world()) < told);
  // It was driven: without the work its energy would have risen.
  CHECK(run.world().resource<EnergyGiven>().by_forces != 0);
}

TEST_CASE("a force on variables of an ode gives the energy that it brings", "[verification]") {
  Json scene = half_full_box<2>();
  scene["ode"] = Json::parse(R"({"a": {"start": 0, "rate": "b"}, "b": {"start": 5, "rate": "-25*a"}})");
  scene["body_force"][0] = "2*a";
  CHECK(rise_after(scene, 100) < told);
}

TEST_CASE("the work of a force is that on a liquid that it moves as a whole", "[verification]") {
  // A periodic stream under b = cos t along it: W = K = m sin^2 t/2, m = 500 kg.
  Json scene = half_full_box<2>();
  scene["walls"] = {{"x", "periodic"}, {"y", "slip"}};
  scene["fluid"]["viscosity"] = 0;
  scene["integrator"]["scheme"] = GENERATE("midpoint", "newmark");
  scene["body_force"] = {"cos(t)", 0};
  SceneRun run(scene);
  run.step(100);
  // Second order in the step of 0.01 s, which is 1e-5 of it.
  CHECK(run.world().resource<EnergyGiven>().by_forces == Approx(250 * std::pow(std::sin(1.0), 2)).epsilon(2e-4));
}

TEST_CASE("a sponge that drives the liquid gives it energy", "[verification]") {
  Json scene = half_full_box<2>();
  scene["sponge"] = Json::parse(R"([{"where": "x < 0.5", "rate": 5, "toward": [1, 0]}])");
  CHECK(rise_after(scene, 100) < told);
}

TEST_CASE("a fountain has the energy that it was given where it comes in", "[verification]") {
  const std::string side = GENERATE("y_low", "x_low");
  Json scene = half_full_box<2>();
  scene["openings"] = {
      {{"name", "inlet"}, {"side", side}, {"where", side == "y_low" ? "x > 0.35 && x < 0.65" : "y < 0.3"}}};
  scene["openings"][0]["inflow"]["velocity"] = side == "y_low" ? Json({0, 1}) : Json({1, 0});
  CAPTURE(side);
  CHECK(rise_after(scene, 100) < told);
}
