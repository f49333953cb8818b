/// \file
/// Iterations of thick liquids around bodies in 2-D, (E119).

#include "support/scene_run.hpp"

#include "engine/run/linear_solver.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// Iterations in the third step of a liquid that sticks to a disc and to the box, and that its weight drives.
std::int64_t iterations_around_disc(const Json& fluid, int cells, double step) {
  Json scene = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1]}, "walls": "no_slip",
    "body_force": [10, -10], "particles": [{"shape": {"where": "y < 0.8"}, "per_cell": 2}],
    "bodies": [{"name": "core", "shape": {"ball": {"center": [0.45, 0.4], "radius": 0.15}}, "wall": "no_slip"}]})");
  scene["grid"]["cells"] = {cells, cells};
  scene["fluid"] = fluid;
  scene["time"] = {{"end", 1}, {"step", step}};
  SceneRun run(scene);
  run.step(3);
  const auto& report = run.world().resource<SolveReport>();
  CHECK(report.residual <= 1e-8);  // of what was found, and not of the iteration
  return report.iterations;
}

}  // namespace

TEST_CASE("stiff friction around a body takes as many iterations on fine grids", "[verification][long]") {
  SECTION("of a Newtonian liquid, nu dt/h^2 = 100") {
    const Json fluid{{"density", 1}, {"viscosity", 1}};
    CHECK(iterations_around_disc(fluid, 64, 100 / 4096.0) < 45);  // 30; 95 with the diagonal alone
  }
  SECTION("of a liquid with a yield stress, of a contrast of 1e5 and more") {
    const int cells = GENERATE(64, 96);
    CAPTURE(cells);
    Json fluid{{"density", 1}};
    fluid["rheology"]["iterations"] = 1;
    fluid["rheology"]["bingham"] = {{"yield_stress", 0.2}, {"viscosity", 1e-2}, {"regularization", 1e5}};
    CHECK(iterations_around_disc(fluid, cells, 0.01) < 50);  // 31 at 64; 184 with the diagonal alone
  }
}
