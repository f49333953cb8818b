/// \file
/// Liquids whose viscosity depends on the shear rate, against exact flows between plates and down a plane.

#include "support/scene_run.hpp"

#include "components/measure.hpp"
#include "components/rheology.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A channel of width 1 m, `cells` across, under a force of 1 m/s^2 along it, until the flow is steady; error of the
/// velocity.
double channel_error(const std::string& law, const std::string& exact, int cells, int steps, int degree = 2) {
  Json scene = scene_of_file("bingham_channel.json");
  scene["grid"]["cells"] = {cells / 2, cells};
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  scene["fluid"]["rheology"] = Json::parse(law);
  scene["exact"]["velocity"] = {exact, 0};
  SceneRun run(scene);
  run.step(steps);
  const double* error = run.world().resource<measure::Columns>().find("error_velocity");
  REQUIRE(error != nullptr);
  return *error;
}

const std::string bingham = R"({"bingham": {"yield_stress": 0.2, "viscosity": 1}})";
const std::string bingham_exact = "0.5*(0.25 - max(abs(y - 0.5), 0.2)^2) - 0.2*(0.5 - max(abs(y - 0.5), 0.2))";

}  // namespace

TEST_CASE("a yield-stress liquid flows through a channel around a plug", "[verification][long]") {
  CHECK(channel_error(bingham, bingham_exact, 16, 100) < 1e-2);    // 7.5e-3 measured
  CHECK(channel_error(bingham, bingham_exact, 32, 100) < 2.5e-3);  // 2.1e-3
  CHECK(channel_error(bingham, bingham_exact, 16, 60, 3) < 2e-2);  // 1.7e-2
}

TEST_CASE("shear-thinning and -thickening liquids flow through a channel by their power law", "[verification]") {
  const auto law = [](double n) {
    return R"({"power_law": {"consistency": 1, "min_viscosity": 1e-3, "max_viscosity": 1e3, "index": )" +
           std::to_string(n) + "}}";
  };
  CHECK(channel_error(law(0.5), "(0.5^3 - abs(y - 0.5)^3)/3", 16, 200) < 1e-2);  // 7.9e-3 measured
  CHECK(channel_error(law(1.5), "0.6*(0.5^(5/3) - abs(y - 0.5)^(5/3))", 16, 200) < 5e-3);
}

TEST_CASE("a liquid that yields and thins flows through a channel", "[verification]") {
  const std::string law = R"({"herschel_bulkley": {"yield_stress": 0.2, "consistency": 1, "index": 0.5}})";
  CHECK(channel_error(law, "(0.3^3 - max(abs(y - 0.5) - 0.2, 0)^3)/3", 16, 200) < 2e-2);  // 1.7e-2 measured
}

TEMPLATE_TEST_CASE_SIG("a power law with index 1 is a Newtonian liquid", "[verification]", ((int Dim), Dim), 2, 3) {
  Json scene = scene_of_file(Dim == 2 ? "dam_break.json" : "dam_break_3d.json");
  scene["grid"]["cells"] = Dim == 2 ? Json({20, 20}) : Json({16, 8, 16});
  scene["fluid"] = {{"density", 1000}, {"viscosity", 50}};
  scene["time"] = {{"end", 1}, {"step", 2e-3}};
  const auto speeds = [](const Json& of) {
    SceneRun run(of);
    run.step(20);
    return by_id<particle::Velocity<Dim>>(run.world());
  };
  const auto newtonian = speeds(scene);
  scene["fluid"] = Json::parse(R"({"density": 1000, "rheology": {"power_law": {"consistency": 50, "index": 1,
    "min_viscosity": 0, "max_viscosity": 1e6}}})");
  const auto power_law = speeds(scene);
  double largest = 0;
  for (std::size_t p = 0; p < newtonian.size(); ++p) largest = std::max(largest, (newtonian[p] - power_law[p]).norm());
  CHECK(largest < 1e-7);  // what the solver leaves
}

TEST_CASE("liquids with a yield stress give the same bits on any number of threads", "[verification][threads]") {
  const auto after = [](Execution execution) {
    SceneRun run(scene_of_file("bingham_channel.json"), execution);
    run.step(20);
    return state(run.world());
  };
  CHECK(after(Execution::graph) == after(Execution::list));
}
