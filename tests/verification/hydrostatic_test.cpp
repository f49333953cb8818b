#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scenes.hpp"

#include "components/grid.hpp"
#include "components/node.hpp"

using namespace minamo;
using namespace minamo::scene_run;

namespace {

constexpr double still_depth = 0.5;  // [m]
constexpr double g = 10;             // [m/s^2]
constexpr double density = 1000;

/// A tank of 10 cells of 0.1 m, half full, at rest; the walls' side is `gravity`.
Json column(const std::string& gravity) {
  Json scene = paper(Json::parse(R"({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
    "fluid": {"density": 1000, "viscosity": 1e-3},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "per_cell": 2}],
    "time": {"end": 0.2, "step": 0.002}})"));
  scene["body_force"] = Json::parse(gravity);
  return scene;
}

/// Largest |p - rho g (H - y)| over nodes below y = `up_to`, over rho g H.
double pressure_error(World& world, double up_to) {
  const Grid<2>& grid = world.resource<Grid<2>>();
  const auto p_i = kernels::on_grid<2, node::Pressure>(world);
  Largest worst;
  for (int j = 0; j <= grid.cells[1]; ++j) {
    for (int i = 0; i <= grid.cells[0]; ++i) {
      const Vec<2> x = grid.position({i, j});
      if (x[1] > up_to) continue;
      worst.add(std::abs(p_i[grid.row({i, j})] - density * g * (still_depth - x[1])));
    }
  }
  return worst.value() / (density * g * still_depth);
}

double largest_speed(World& world) {
  Largest largest;
  for (const Vec<2>& v : world.column<particle::Velocity<2>>()) largest.add(v.norm());
  return largest.value();
}

}  // namespace

TEST_CASE("a column at rest stays at rest and has the hydrostatic pressure", "[verification]") {
  SceneRun run(any_method(column("[0, -10]")));
  CAPTURE(run.scene().schemes);
  run.step(100);
  // 0.6 to 0.9 % of rho g H at 5 cells deep, from the stabilization and the surface, one half cell wide.
  CHECK(pressure_error(run.world(), 0.45) < 0.012);
  // The surface settles by a fraction of a cell: 1e-3 m/s, 5e-3 m/s with FLIP's noise; free fall would be 2 m/s.
  CHECK(largest_speed(run.world()) < 9e-3);
}

TEST_CASE("where a corner has few particles the pressure is that of the liquid around it", "[verification]") {
  SceneRun run(Json::parse(R"json({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]}, "fluid": {"density": 1000, "viscosity": 0},
    "body_force": [0, -9.81], "particles": [{"shape": {"where": "y < 0.5 && x^2 + y^2 > 0.0026"}, "per_cell": 2}],
    "probes": [{"name": "corner", "at": [0, 0]}], "volume": {"scheme": "none"}, "time": {"end": 1, "step": 1e-3}})json"));
  run.step(2);
  const double p = measured(run.world(), "corner_pressure");
  CHECK(p > 0.5 * 4905);
  CHECK(p < 2 * 4905);  // by its own particles alone it was 96 times as large
}
