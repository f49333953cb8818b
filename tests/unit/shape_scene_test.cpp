#include "support/reading.hpp"
#include "support/scene_run.hpp"
#include "support/solids.hpp"

#include "support/folder.hpp"
#include "systems/scene/read_shape.hpp"
#include "systems/step/register.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace minamo;

namespace {

/// Twenty cells per direction of 0.05 m, with one region.
Json box(int dimension, const std::string& shape) {
  Json scene = Json::parse(R"({"fluid": {"density": 1000, "viscosity": 0}, "time": {"end": 1, "step": 0.001},
    "discretization": {"scheme": "equal_order"}})");
  scene["dimension"] = dimension;
  scene["grid"] = {{"low", Json::array_t(static_cast<std::size_t>(dimension), 0)},
                   {"high", Json::array_t(static_cast<std::size_t>(dimension), 1)},
                   {"cells", Json::array_t(static_cast<std::size_t>(dimension), 20)}};
  scene["particles"] = Json::array({{{"shape", Json::parse(shape)}, {"per_cell", dimension == 2 ? 4 : 2}}});
  return scene;
}

/// Of the particles of a region, by their number. [m^d]
double measure(int dimension, const std::string& shape) {
  scene_run::SceneRun run(box(dimension, shape));
  double sum = 0;
  for (const double V_p : run.world().column<particle::Volume>()) sum += V_p;
  return sum;
}

}  // namespace

TEST_CASE("regions of every shape in 2-D have its area", "[unit]") {
  using std::numbers::pi;
  const auto [shape, area] = GENERATE(table<std::string, double>({
      {R"({"box": {"low": [0.3, 0.4], "high": [0.8, 0.6], "angle": 30}})", 0.1},
      {R"({"ball": {"center": [0.5, 0.5], "radius": 0.3}})", 0.09 * pi},
      {R"({"ellipsoid": {"center": [0.5, 0.5], "radii": [0.4, 0.2], "angle": "180/4"}})", 0.08 * pi},
      {R"({"capsule": {"from": [0.3, 0.3], "to": [0.6, 0.7], "radius": 0.2}})", 0.2 + 0.04 * pi},
      {R"({"half_space": {"point": [0, 0.3], "normal": [1, 1]}})", 0.045},
      {R"({"polygon": {"vertices": [[0.1, 0.1], [0.5, 0.9], ["0.6 + 0.3", 0.1]]}})", 0.32},
      {R"json({"distance": "y - 0.3 - 0.1*cos(2*pi*x)"})json", 0.3},
      {R"json({"where": "y < 0.3 + 0.1*cos(2*pi*x)"})json", 0.3},
      {R"({"union": [{"ball": {"center": [0.5, 0.5], "radius": 0.3}},
                     {"box": {"low": [0.5, 0.2], "high": [0.8, 0.8]}}]})",
       0.045 * pi + 0.18},
      {R"({"intersection": [{"ball": {"center": [0.5, 1], "radius": 0.3}},
                            {"half_space": {"point": [0.5, 0], "normal": [1, 0]}}]})",
       0.0225 * pi},
      {R"({"difference": [{"box": {"low": [0, 0], "high": [1, 1]}}, {"ball": {"center": [0.5, 0.5], "radius": 0.4}},
                          {"invert": {"half_space": {"point": [0, 0.5], "normal": [0, 1]}}}]})",
       0.5 - 0.08 * pi},
  }));
  CAPTURE(shape);
  CHECK(measure(2, shape) == Approx(area).margin(0.006));  // of 6400 places some dozens at the edge are in or out
}

TEST_CASE("regions of every shape in 3-D have its volume", "[unit]") {
  using std::numbers::pi;
  const auto [shape, volume] = GENERATE(table<std::string, double>({
      {R"({"box": {"low": [0.3, 0.4, 0.2], "high": [0.8, 0.6, 0.8], "angle": 30, "axis": [1, 1, 1]}})", 0.06},
      {R"({"ellipsoid": {"center": [0.5, 0.5, 0.5], "radii": [0.4, 0.2, 0.3], "angle": 45}})", 0.032 * pi},
      {R"({"cylinder": {"from": [0.3, 0.3, 0.3], "to": [0.7, 0.7, 0.5], "radius": 0.2}})", 0.024 * pi},
      {R"({"capsule": {"from": [0.3, 0.3, 0.3], "to": [0.7, 0.7, 0.5], "radius": 0.2}})", 0.024 * pi + 0.032 / 3 * pi},
  }));
  CAPTURE(shape);
  CHECK(measure(3, shape) == Approx(volume).margin(0.003));
}

TEST_CASE("a region by a mesh has its volume", "[unit]") {
  const Folder folder;
  solids::write_binary_stl(folder / "box.stl", solids::box({0, 0, 0}, {4, 6, 8}));
  const std::string file = folder / "box.stl";
  const std::string shape = R"({"mesh": {"file": ")" + file + R"(", "scale": 0.1, "move": [0.25, 0.2, 0.1]}})";
  CHECK(measure(3, shape) == Approx(0.192).margin(0.003));
}

TEST_CASE("a turned shape stands as it should", "[unit]") {
  // A quarter turn about z takes x to y.
  const std::string quarter = R"({"box": {"low": [0.1, 0.4, 0.4], "high": [0.9, 0.6, 0.5], "angle": 90}})";
  scene_run::SceneRun run(box(3, quarter));
  Vec<3> low = Vec<3>::Constant(1), high = Vec<3>::Zero();
  for (const Vec<3>& x : run.world().column<particle::Position<3>>()) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  CHECK((low - Vec<3>(0.4125, 0.1125, 0.4125)).norm() < 1e-12);
  CHECK((high - Vec<3>(0.5875, 0.8875, 0.4875)).norm() < 1e-12);
}

TEST_CASE("the file of a mesh lies next to the scene, and the scene as run has its whole path", "[unit]") {
  const Folder folder;
  solids::write_obj(folder / "ball.obj", solids::ball(1));
  const Json scene = box(3, R"({"mesh": {"file": "./ball.obj", "scale": 0.3, "move": [0.5, 0.5, 0.5]}})");
  SystemRegistry registry;
  register_parts(registry);
  const SceneFile file = understand_scene(scene, folder / "scene.json", registry, {});
  CHECK(file.as_run["particles"][0]["shape"]["mesh"]["file"] == folder / "ball.obj");
  CHECK_NOTHROW(understand_scene(file.as_run, "elsewhere.json", registry, {}));
}

TEST_CASE("the schema of a shape within a shape is that of the shape", "[unit]") {
  SystemRegistry registry;
  register_parts(registry);
  Input::Document document = Input::Document::describe();
  describe_scene(document.root(), registry);
  const Json schema = document.schema();
  const std::string reference = "/properties/particles/items/properties/shape";
  REQUIRE(schema.contains(Json::json_pointer(reference)));
  const Json& shape = schema[Json::json_pointer(reference)];
  Json found;
  for (const Json& alternative : shape["allOf"][0]["oneOf"]) {
    const Json& properties = alternative["properties"];
    if (properties["union"].is_object()) found["union"] = properties["union"]["items"];
    if (properties["invert"].is_object()) found["invert"] = properties["invert"]["$ref"];
  }
  CHECK(found.dump() == Json({{"union", {{"$ref", "#" + reference}}}, {"invert", "#" + reference}}).dump());
}

TEST_CASE("points are read as lists of numbers", "[unit]") {
  using reading::value_of;
  using Points = std::vector<std::vector<double>>;
  const auto read_points = [](Input& in) {
    in.use_constants({{"H", 0.5}});
    return in.points("a", 2, 1, {});
  };
  CHECK(value_of<Points>(R"({"a": [[1, 2], ["2*H", 3]]})", read_points) == Points{{1, 2}, {1, 3}});
}
