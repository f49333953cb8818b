#include "support/scene_run.hpp"
#include "systems/step/memory.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

/// 1 m x 0.5 m, 40 x 20 cells, with one region.
Scene with_shape(const std::string& shape, int cells = 40, const std::string& solver = "block") {
  Json json = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 0.5]},
    "fluid": {"density": 1000, "viscosity": 0}, "particles": [{"per_cell": 3}], "time": {"end": 1, "step": 0.01}})");
  json["solver"]["scheme"] = solver;
  json["grid"]["cells"] = {cells, cells / 2};
  json["particles"][0]["shape"] = Json::parse(shape);
  return scene_run::read(json);
}

}  // namespace

TEST_CASE("a scene is at least as large as what is seeded, and not much larger", "[unit]") {
  const std::string shape = GENERATE(as<std::string>(), R"({"box": {"low": [0, 0], "high": [0.5, 0.25]}})",
                                     R"({"box": {"low": [0, 0], "high": [1, 0.01]}})",
                                     R"({"ball": {"center": [0.5, 0.25], "radius": 0.2}})", R"({"where": "y < x/3"})");
  CAPTURE(shape);
  const Scene scene = with_shape(shape);
  World world;
  seed(scene, "scene.json", world);
  const auto seeded = static_cast<double>(world.rows("particle"));
  const double counted = size_of(scene).particles;
  CHECK(counted >= seeded);
  // One part more per direction, of 60 x 30 at most; of the layer 121 x 2 parts for 120 x 1.
  CHECK(counted <= std::max(1.1 * seeded, seeded + 122));
}

TEST_CASE("a shape on many cells is counted by samples", "[unit]") {
  // 9e6 places, of which a twentieth lies in the layer: 1000 of 2e4 samples, that is within 10 % (three sigma).
  const Scene scene = with_shape(R"({"where": "y < 0.025"})", 1414);
  const SceneSize size = size_of(scene);
  CHECK(size.places == 1414. * 707 * 9);
  CHECK(size.particles == Approx(0.05 * size.places).epsilon(0.02));
}

TEST_CASE("a finer scene, one with UMFPACK and one in 3-D need more memory", "[unit]") {
  const std::string box = R"({"box": {"low": [0, 0], "high": [0.5, 0.25]}})";
  const auto memory = [](const Scene& scene) { return memory_of(scene, size_of(scene)); };
  CHECK(memory(with_shape(box, 80)) > memory(with_shape(box)));
  CHECK(memory(with_shape(box, 40, "umfpack")) > memory(with_shape(box)));
  CHECK(memory(scene_run::read(scene_run::scene_of_file("dam_break_3d.json"))) >
        memory(scene_run::read(scene_run::scene_of_file("dam_break.json"))));
}
