#include "support/scene_run.hpp"

#include "engine/run/warnings.hpp"
#include "systems/step/time_plan.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;
using Catch::Matchers::Contains;

namespace {

/// A block of liquid in the lower half of a closed box of 1 m with cells of 0.1 m.
Json block(int dimension, double step) {
  Json scene = Json::parse(R"({"fluid": {"density": 1000, "viscosity": 1e-3}})");
  const auto d = static_cast<std::size_t>(dimension);
  scene["dimension"] = dimension;
  scene["grid"] = {{"low", std::vector(d, 0.0)}, {"high", std::vector(d, 1.0)}, {"cells", std::vector(d, 10)}};
  scene["particles"] = Json::array();
  scene["particles"].push_back(
      {{"shape", {{"box", {{"low", std::vector(d, 0.25)}, {"high", std::vector(d, 0.5)}}}}}, {"per_cell", 2}});
  scene["time"] = {{"end", 10}, {"step", step}};
  return scene;
}

std::vector<std::string> warnings_after(const Json& scene, int steps) {
  SceneRun run(scene);
  run.step(steps);
  return run.world().resource<Warnings>().texts();
}

/// The block thrown along an axis with 1 m/s, with a weight against it.
Json thrown(int dimension, std::size_t axis, int sign) {
  Json scene = block(dimension, 0.05);
  std::vector<double> v(static_cast<std::size_t>(dimension), 0.0);
  v[axis] = sign;
  scene["particles"][0]["velocity"] = v;
  v[axis] = -0.01 * sign;
  scene["body_force"] = v;
  return scene;
}

/// The step that a CFL number of 0.5 gives the block at rest near moving bodies.
double first_step(int dimension, const std::string& motion, const std::string& more = "") {
  Json scene = with(block(dimension, 1), {R"(/time={"end": 10, "cfl": 0.5})", "/output={\"every\": 10}"});
  const std::string box = dimension == 2 ? R"({"low": [0.6, 0.1], "high": [0.8, 0.4]})"
                                         : R"({"low": [0.6, 0.1, 0.1], "high": [0.8, 0.4, 0.4]})";
  scene["bodies"] =
      Json::parse(R"([{"name": "a", "shape": {"box": )" + box + R"(}, "motion": )" + motion + more + "}]");
  const Scene read_scene = read(scene);
  World world;
  seed(read_scene, "scene.json", world);
  return make_time_plan(read_scene).choose_step(world);
}

}  // namespace

TEST_CASE("a fixed step of many cells is warned of once, with the step that would do", "[property]") {
  const int dimension = GENERATE(2, 3);
  Json scene = block(dimension, 0.3);
  scene["walls"] = {{"x", "periodic"}};
  scene["particles"][0]["velocity"] = dimension == 2 ? Json({1, 0}) : Json({1, 0, 0});
  const auto found = warnings_after(scene, 2);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains("the fastest particle crosses 3 cells in the step of 0.3 s"));
  CHECK_THAT(found[0], Contains(R"("time": {"step": 0.1} gives a CFL number of 1)"));
}

TEST_CASE("a fixed step of up to two cells is no reason for a warning", "[property]") {
  Json scene = with(block(2, 0.19), {R"(/walls={"x": "periodic"})", "/particles/0/velocity=[1, 0]"});
  CHECK(warnings_after(scene, 2).empty());
}

TEST_CASE("liquid that touches the lid of an open tank is told once, whichever side is above", "[property]") {
  const int dimension = GENERATE(2, 3);
  const auto axis = GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{2});
  const int sign = GENERATE(1, -1);
  if (axis >= static_cast<std::size_t>(dimension)) return;
  CAPTURE(dimension, axis, sign);
  const auto found = warnings_after(thrown(dimension, axis, sign), 16);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains(std::string("touches the lid, the ") + (sign > 0 ? "high" : "low") + " side of " +
                                "xyz"[axis] + ", at x = ") &&
                           Contains(", t = 0."));
  CHECK(warnings_after(thrown(dimension, axis, sign), 2).empty());
}

TEST_CASE("a lid that holds nothing, or that the liquid starts at, is no reason for a warning", "[property]") {
  const Json up = thrown(2, 1, 1);
  CHECK(warnings_after(with(up, {R"(/walls={"y": ["slip", "separating"]})"}), 16).empty());
  CHECK(warnings_after(with(up, {R"(/openings=[{"name": "top", "side": "y_high", "outflow": "free"}])"}), 16).empty());
  CHECK(warnings_after(with(up, {R"(/walls={"y": "periodic"})"}), 16).empty());
  CHECK(warnings_after(with(up, {"/particles/0/shape/box/high=[0.5, 1]"}), 2).empty());
  // Without a weight nothing is above.
  CHECK(warnings_after(with(up, {"/body_force=[0, 0]"}), 16).empty());
}

TEST_CASE("the step from a CFL number sees how fast bodies move", "[property]") {
  const int dimension = GENERATE(2, 3);
  CAPTURE(dimension);
  const std::string zeros = dimension == 2 ? "0]" : "0, 0]";
  const auto moving = [&](const std::string& velocity, const std::string& more = "") {
    return first_step(dimension, R"({"prescribed": {"velocity": [)" + velocity + ", " + zeros + more + "}}");
  };
  // cfl h = 0.05 m
  CHECK(moving("2") == Approx(0.025).epsilon(1e-14));
  CHECK(moving("\"-2\"") == Approx(0.025).epsilon(1e-14));
  // From rest: what it reaches within the step that the liquid would take, 10 s, as long as a frame.
  CHECK(moving("\"0.1*t\"") == Approx(0.05).epsilon(1e-14));
  // Corners are sqrt(.1^2 + .15^2 (+ .15^2)) m from the middle.
  const double r = std::sqrt(dimension == 2 ? 0.0325 : 0.055);
  CHECK(moving("0", R"(, "rotation": {"rate": "3"})") == Approx(0.05 / (3 * r)).epsilon(1e-14));
  CHECK(first_step(dimension, R"({"free": {"density": 500, "velocity": [0, )" +
                                  std::string(dimension == 2 ? "" : "0, ") + "-4]}}") == Approx(0.0125).epsilon(1e-14));
}
