#include "support/scenes.hpp"

#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/node.hpp"

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// The rotating square patch on 40 cells across 5 m; 8 cells across the square.
Json patch(const std::string& integrator) {
  return with(paper(scene_of_file("rotating_square.json")),
              {"/grid/cells=[40, 40]", "/particles/0/per_cell=4", R"(/integrator={"scheme": ")" + integrator + "\"}",
               "/time/step=0.005"});
}

double centre_pressure(World& world) {
  const Grid<2>& grid = world.resource<Grid<2>>();
  return world.column<node::Pressure>()[grid.row({grid.cells[0] / 2, grid.cells[1] / 2})];
}

constexpr double exact_centre = -147.343;         // -0.147343 rho omega^2 L^2 [Pa]
constexpr double exact_spin = 1000.0 / 6;         // rho omega L^4/6 [kg m^2/s]

}  // namespace

TEST_CASE("the rotating square has the exact pressure in its centre after a step", "[verification]") {
  const std::string integrator = GENERATE("newmark", "midpoint");
  CAPTURE(integrator);
  SceneRun run(patch(integrator));
  run.step();
  CHECK(centre_pressure(run.world()) == Approx(exact_centre).epsilon(0.05));
}

TEST_CASE("the rotating square starts with its exact angular momentum", "[verification]") {
  SceneRun run(patch("newmark"));
  run.start();
  CHECK(run.world().resource<measure::Momentum<2>>().angular[0] == Approx(exact_spin).epsilon(0.02));
}

TEST_CASE("the rotating square keeps its angular momentum", "[verification]") {
  const std::string integrator = GENERATE("newmark", "midpoint");
  CAPTURE(integrator);
  SceneRun run(patch(integrator));
  run.start();
  const double before = run.world().resource<measure::Momentum<2>>().angular[0];
  run.step(20);
  CHECK(run.world().resource<measure::Momentum<2>>().angular[0] == Approx(before).epsilon(1e-3));
}

TEST_CASE("the first pressures of Newmark do not oscillate", "[verification]") {
  SceneRun run(patch("newmark"));
  std::vector<double> p;
  for (int k = 0; k < 6; ++k) {
    run.step();
    p.push_back(centre_pressure(run.world()));
  }
  CAPTURE(p);
  double jump = 0;
  for (std::size_t k = 1; k < p.size(); ++k) jump = std::max(jump, std::abs(p[k] - p[k - 1]));
  CHECK(jump < 0.01 * std::abs(exact_centre));
}
