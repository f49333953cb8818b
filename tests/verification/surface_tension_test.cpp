/// \file
/// Drops: the pressure inside, how they swing, and the angle at which they rest on walls.

#include "support/scene_run.hpp"

#include "components/measure.hpp"
#include "components/surface_tension.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double pi = std::numbers::pi;

/// A drop at rest with sigma = rho = 1, radius 0.25 m, viscosity 0.02 Pa s, in a box of 1 m.
template <int Dim>
Json drop_at_rest(int cells, double step) {
  Json scene = Json::parse(R"({"walls": "slip", "fluid": {"density": 1, "viscosity": 0.02},
    "surface_tension": {"coefficient": 1}})");
  scene["dimension"] = Dim;
  scene["grid"] = {{"low", std::vector<double>(Dim, 0)},
                   {"high", std::vector<double>(Dim, 1)},
                   {"cells", std::vector<int>(Dim, cells)}};
  scene["particles"] = {
      {{"shape", {{"ball", {{"center", std::vector<double>(Dim, 0.5)}, {"radius", 0.25}}}}}, {"per_cell", 3}}};
  scene["probes"] = {{{"name", "middle"}, {"at", std::vector<double>(Dim, 0.5)}}};
  scene["time"] = {{"end", 1}, {"step", step}};
  return scene;
}

/// Of a drop of the volume that the particles have. [m]
template <int Dim>
double radius_of(World& world) {
  double volume = 0;
  for (const double V : world.column<particle::Volume>()) volume += V;
  return Dim == 2 ? std::sqrt(volume / pi) : std::cbrt(3 * volume / (4 * pi));
}

template <int Dim>
double largest_speed(World& world) {
  double largest = 0;
  for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) largest = std::max(largest, v.norm());
  return largest;
}

}  // namespace

TEST_CASE("the pressure in a drop at rest is that of its curvature", "[verification]") {
  SceneRun run(drop_at_rest<2>(32, 1e-3));
  run.step(150);
  const double expected = 1 / radius_of<2>(run.world());
  CHECK(measured(run.world(), "middle_pressure") == Approx(expected).epsilon(3e-3));  // 0.7e-3 measured at 0.3 s
  // A capillary number of 1e-3 is a speed of 0.05 m/s.
  CHECK(largest_speed<2>(run.world()) < 0.05);
}

TEST_CASE("the pressure in a drop in space is that of its curvature", "[verification][long]") {
  SceneRun run(drop_at_rest<3>(16, 2.5e-3));
  run.step(60);
  const double expected = 2 / radius_of<3>(run.world());
  CHECK(measured(run.world(), "middle_pressure") == Approx(expected).epsilon(0.03));  // 4 cells per radius
}

TEST_CASE("a drop swings with the frequency of its surface tension", "[verification]") {
  Json scene = scene_of_file("oscillating_drop.json");
  scene["constants"]["a"] = 0.05;
  scene["fluid"]["viscosity"] = 1e-3;
  SceneRun run(scene);
  run.start();
  World& world = run.world();
  const double R = radius_of<2>(world);
  const double period = 2 * pi / std::sqrt(6 / (R * R * R));
  // Stretched along x, it is a circle after a quarter of a period.
  const auto stretch = [&] {
    Vec<2> second = Vec<2>::Zero();
    for (const Vec<2>& x : world.column<particle::Position<2>>()) second += (x - Vec<2>::Constant(0.5)).cwiseAbs2();
    return second[0] / second[1] - 1;
  };
  const double step = 1e-3;
  double time = 0;
  double before = stretch();
  std::vector<double> crossings;
  while (time < 1.4 * period && crossings.size() < 3) {
    run.step();
    time += step;
    const double now = stretch();
    if (now * before < 0) crossings.push_back(time - step * now / (now - before));
    before = now;
  }
  REQUIRE(crossings.size() == 3);
  CHECK(crossings[2] - crossings[0] == Approx(period).epsilon(0.02));  // 8 cells per radius
}

TEST_CASE("a drop rests on a wall at its contact angle", "[verification][long]") {
  const double angle = GENERATE(60.0, 120.0);
  CAPTURE(angle);
  Json scene = scene_of_file("sessile_drop.json");
  scene["grid"] = {{"low", {0, 0}}, {"high", {1, 0.5}}, {"cells", {24, 12}}};
  scene["surface_tension"]["contact_angle"] = angle;
  scene["time"]["step"] = 1.5e-3;
  SceneRun run(scene);
  run.step(700);
  // Of a circular segment of this area the base is 2 r sin(angle).
  double area = 0;
  for (const double V : run.world().column<particle::Volume>()) area += V;
  const double a = angle * pi / 180;
  const double r = std::sqrt(area / (a - std::sin(a) * std::cos(a)));
  CHECK(run.world().resource<FreeSurface<2>>().wetted == Approx(2 * r * std::sin(a)).epsilon(0.03));
}

TEST_CASE("surface tension gives the same bits on any number of threads", "[verification][threads]") {
  const auto after = [](Execution execution) {
    SceneRun run(scene_of_file("sessile_drop.json"), execution);
    run.step(10);
    return state(run.world());
  };
  CHECK(after(Execution::graph) == after(Execution::list));
}
