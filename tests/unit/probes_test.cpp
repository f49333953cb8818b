#include "systems/measure/probes.hpp"

#include "support/kernels.hpp"
#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;
using scene_run::SceneRun;

namespace {

template <int Dim>
double linear(const Vec<Dim>& x) {
  return 3 + x.sum();
}

/// Every node has mass, the pressure 3 + x + y (+ z), and the velocity that times (1, 2, 3).
template <int Dim>
void linear_fields(World& world) {
  const Grid<Dim> grid = small_grid<Dim>();
  set_grid<Dim>(world, grid);
  for (std::size_t i = 0; i < grid.node_count(); ++i) {
    const double value = linear<Dim>(node_position(grid, i));
    world.column<node::Mass>()[i] = 1;
    world.column<node::Pressure>()[i] = value;
    world.column<node::NewVelocity<Dim>>()[i] = value * Vec<Dim>::LinSpaced(1, Dim);
  }
}

template <int Dim>
void add_probe(World& world, const Vec<Dim>& at) {
  typename measure::Probes<Dim>::Probe probe;
  probe.at = at;
  probe.pressure = "p";
  for (std::size_t d = 0; d < Dim; ++d) probe.velocity[d] = std::string(1, "uvw"[d]);
  world.resource<measure::Probes<Dim>>().probes.push_back(probe);
}

double column(World& world, const std::string& name) {
  const double* value = world.resource<measure::Columns>().find(name);
  REQUIRE(value);
  return *value;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a probe in the liquid sees linear fields as they are", "[unit]", ((int Dim), Dim), 2, 3) {
  const double share = GENERATE(0.0, 0.01, 0.37, 0.5, 1.0);  // of the box: walls, half cells at walls, inside
  CAPTURE(share);
  World world;
  linear_fields<Dim>(world);
  const Grid<Dim> grid = small_grid<Dim>();
  const Vec<Dim> at = grid.low + share * (grid.high - grid.low);
  add_probe<Dim>(world, at);
  run<MeasureProbes<Dim>>(world);
  CHECK(std::abs(column(world, "p") - linear<Dim>(at)) < 8e-15);
  CHECK(std::abs(column(world, "u") - linear<Dim>(at)) < 8e-15);
  CHECK(std::abs(column(world, "v") - 2 * linear<Dim>(at)) < 1.5e-14);
}

TEST_CASE("a dry probe is zero", "[unit]") {
  World world;
  linear_fields<2>(world);
  for (double& m : world.column<node::Mass>()) m = 0;
  add_probe<2>(world, {2, 0});
  run<MeasureProbes<2>>(world);
  CHECK(column(world, "p") == 0);
  CHECK(column(world, "u") == 0);
  CHECK(column(world, "v") == 0);
}

TEST_CASE("nodes without mass do not slow a probe at the surface down", "[unit]") {
  World world;
  linear_fields<2>(world);
  const Grid<2> grid = small_grid<2>();
  for (std::size_t i = 0; i < grid.node_count(); ++i) {
    const bool wet = node_position(grid, i)[1] < 0.1;
    world.column<node::Mass>()[i] = wet ? 1 : 0;
    world.column<node::NewVelocity<2>>()[i] = wet ? Vec<2>(1, -4) : Vec<2>(0, 0);
  }
  add_probe<2>(world, {2, 0.2});
  run<MeasureProbes<2>>(world);
  CHECK(std::abs(column(world, "u") - 1) < 1e-15);
  CHECK(std::abs(column(world, "v") + 4) < 1e-15);
}

TEST_CASE("a probe in a hydrostatic column shows its pressure, the start included", "[unit]") {
  const Json scene =
      scene_run::with(scene_run::scene_of_file("hydrostatic.json"),
                      {R"(/probes=[{"name": "low", "at": [1, 0.1]}, {"name": "dry", "at": [0.5, 0.9]}])"});
  SceneRun run(scene);
  const int steps = GENERATE(0, 3);
  CAPTURE(steps);
  run.start();
  run.step(steps);
  // 8 cells below the surface 4.3e-3; 2.7e-5 m/s, while g dt is 1e-2.
  CHECK(std::abs(column(run.world(), "low_pressure") / (1000 * 9.81 * 0.4) - 1) < 8.5e-3);
  CHECK(std::abs(column(run.world(), "low_velocity_y")) < 5e-5);
  CHECK(column(run.world(), "dry_pressure") == 0);
  CHECK(column(run.world(), "dry_velocity_x") == 0);
}

TEST_CASE("a scene without probes has no system for them", "[unit]") {
  const auto step = make_pipeline(scene_run::read(scene_run::scene_of_file("dam_break.json"))).step;
  CHECK(std::none_of(step.begin(), step.end(), [](const System& system) { return system.name == "measure_probes"; }));
}
