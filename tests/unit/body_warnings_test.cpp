#include "support/folder.hpp"
#include "support/program_output.hpp"
#include "support/scene_run.hpp"

#include "systems/bodies/warnings.hpp"

#include <catch2/catch.hpp>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>

using namespace minamo;
using Catch::Matchers::Contains;
using scene_run::SceneRun;

namespace {

/// A square of 1 m with cells of 5 cm and a layer of liquid; gaps under 0.1 m are thin.
Json near_bodies(const std::string& bodies) {
  Json scene = Json::parse(R"({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [20, 20]},
    "fluid": {"density": 1000, "viscosity": 1e-3},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.1]}}}],
    "time": {"end": 1, "step": 1e-3}})");
  scene["bodies"] = Json::parse(bodies);
  return scene;
}

/// The same with a third direction, 0.5 m and a gap under 0.1 m.
Json around_bodies(const std::string& bodies) {
  Json scene = near_bodies(bodies);
  scene["dimension"] = 3;
  scene["grid"] = Json::parse(R"({"low": [0, 0, 0], "high": [0.5, 0.5, 0.5], "cells": [10, 10, 10]})");
  scene["particles"] = Json::parse(R"([{"shape": {"box": {"low": [0, 0, 0], "high": [0.5, 0.5, 0.1]}}}])");
  return scene;
}

std::vector<std::string> sentences_of(const Json& scene) {
  SceneRun run(scene);
  return warnings_of_bodies(run.scene(), run.world());
}

}  // namespace

TEST_CASE("a thin gap between a body and a side is told with its place and width", "[unit]") {
  const auto found =
      sentences_of(near_bodies(R"([{"name": "a", "shape": {"box": {"low": [0.02, 0.3], "high": [0.3, 0.5]}}}])"));
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains("a gap of 0.02 m between body \"a\" and the low side of x at x = 0.01, y = 0."));
  CHECK_THAT(found[0], Contains("thinner than two cells, 0.1 m"));
}

TEST_CASE("a thin gap near a body that reaches through the sides is told", "[unit]") {
  const auto found =
      sentences_of(near_bodies(R"([{"name": "a", "shape": {"box": {"low": [0.02, -1], "high": [0.3, 2]}}}])"));
  const auto tells = [](const std::string& sentence) {
    return sentence.find("a gap of 0.02 m between body \"a\" and the low side of x at x = 0.01") != std::string::npos;
  };
  CHECK(std::count_if(found.begin(), found.end(), tells) == 1);  // and of liquid that is cut away
}

TEST_CASE("a thin gap between two bodies is told once, a wide one not", "[unit]") {
  const auto bodies = [](double x) {
    return fmt::format(R"([{{"name": "a", "shape": {{"ball": {{"center": [0.3, 0.5], "radius": 0.1}}}}}},
                           {{"name": "b", "shape": {{"box": {{"low": [{}, 0.3], "high": [0.8, 0.7]}}}}}}])",
                       x);
  };
  const auto found = sentences_of(near_bodies(bodies(0.46)));
  REQUIRE(found.size() == 1);
  // The middle is at 0.43 to the distance of the samples.
  CHECK_THAT(found[0], Contains("a gap of 0.06 m") && Contains("between body \"a\" and \"b\" at x = 0.4"));
  CHECK(sentences_of(near_bodies(bodies(0.501))).empty());
}

TEST_CASE("a body in the place of another one is told once", "[unit]") {
  const std::string motion = GENERATE(R"("wall": "slip")", R"("motion": {"free": {"density": 500}})");
  const double radius = GENERATE(0.1, 0.15);
  const auto found = sentences_of(
      near_bodies(fmt::format(R"([{{"name": "a", "shape": {{"ball": {{"center": [0.5, 0.5], "radius": {}}}}}, {}}},
                      {{"name": "b", "shape": {{"ball": {{"center": [0.5, 0.5], "radius": 0.1}}}}, {}}}])",
                              radius, motion, motion)));
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains("body \"b\" lies in the place of \"a\""));
}

TEST_CASE("where bodies touch, stand on each other, reach through a side or meet it at an angle is no gap", "[unit]") {
  const std::string bodies = GENERATE(
      R"([{"name": "ball", "shape": {"ball": {"center": [0.5, 0.3], "radius": 0.3}}}])",
      R"([{"name": "large", "shape": {"ball": {"center": [0.5, 2], "radius": 2}}}])",
      R"([{"name": "sunk", "shape": {"ball": {"center": [0.5, 0.28], "radius": 0.3}}}])",
      R"([{"name": "step", "shape": {"box": {"low": [0.4, 0], "high": [0.6, 0.3]}}},
          {"name": "upon", "shape": {"box": {"low": [0.3, 0.3], "high": [0.7, 0.5]}}}])",
      R"([{"name": "beach", "shape": {"polygon": {"vertices": [[0.5, -0.1], [1.5, -0.1], [1.5, 0.2]]}}}])",
      R"([{"name": "tank", "shape": {"invert": {"box": {"low": [0.2, 0.02], "high": [0.8, 0.8], "angle": 10}}}}])",
      R"([{"name": "wedge", "shape": {"half_space": {"point": [0, 0], "normal": [1, -0.2]}}}])",
      R"([{"name": "a", "shape": {"box": {"low": [0.1, 0.3], "high": [0.3, 0.5]}}},
          {"name": "b", "shape": {"box": {"low": [0.35, 0.3], "high": [0.5, 0.5]}}},
          {"name": "between", "shape": {"box": {"low": [0.29, 0.25], "high": [0.36, 0.55]}}}])");
  CAPTURE(bodies);
  for (const auto& sentence : sentences_of(near_bodies(bodies))) CHECK_THAT(sentence, !Contains("gap"));
}

TEST_CASE("a side that is periodic has no gap next to it", "[unit]") {
  Json scene = near_bodies(R"([{"name": "a", "shape": {"box": {"low": [-1, 0.3], "high": [2, 0.5]}}}])");
  scene["walls"] = Json::parse(R"({"x": "periodic"})");
  for (const auto& sentence : sentences_of(scene)) CHECK_THAT(sentence, !Contains("gap"));
}

TEST_CASE("gaps in 3-D are found", "[unit]") {
  const auto found =
      sentences_of(around_bodies(R"([{"name": "ball", "shape": {"ball": {"center": [0.25, 0.25, 0.35], "radius": 0.1}}},
                                       {"name": "lid", "shape": {"half_space": {"point": [0, 0, 0.48], "normal": [0, 0, -1]}}}])"));
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains("between body \"ball\" and \"lid\"") && Contains("a gap of 0.03"));
}

TEST_CASE("a free body that overlaps a side or another body is told how deep", "[unit]") {
  const auto found = sentences_of(near_bodies(R"([
    {"name": "log", "shape": {"box": {"low": [-0.02, 0.3], "high": [0.3, 0.5]}}, "motion": {"free": {"density": 500}}},
    {"name": "step", "shape": {"box": {"low": [0.27, 0.2], "high": [0.5, 0.6]}}}])"));
  REQUIRE(found.size() == 2);
  CHECK_THAT(found[0], Contains("free body \"log\" overlaps the low side of x by 0.02 m at the start"));
  CHECK_THAT(found[1], Contains("free body \"log\" overlaps \"step\" by 0.03 m at the start"));
}

TEST_CASE("bodies at rest that overlap are told which, how deep and where; those that touch are not", "[unit]") {
  const auto bodies = [](double x) {
    return fmt::format(R"([{{"name": "a", "shape": {{"box": {{"low": [0.3, 0.3], "high": [0.5, 0.5]}}}}}},
                           {{"name": "b", "shape": {{"box": {{"low": [{}, 0.2], "high": [0.8, 0.7]}}}}}}])",
                       x);
  };
  const auto found = sentences_of(near_bodies(bodies(0.47)));
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains("body \"a\" overlaps \"b\" by 0.03 m at the start, at x = 0."));
  CHECK(sentences_of(near_bodies(bodies(0.5))).empty());
}

TEST_CASE("bodies in 3-D that overlap are told", "[unit]") {
  const auto found = sentences_of(
      around_bodies(R"([{"name": "a", "shape": {"box": {"low": [0.1, 0.1, 0.25], "high": [0.3, 0.3, 0.4]}}},
                        {"name": "b", "shape": {"ball": {"center": [0.35, 0.2, 0.3], "radius": 0.1}}}])"));
  const auto tells = [](const std::string& sentence) {
    return sentence.find("overlaps") != std::string::npos &&
           sentence.find(" m at the start, at x = 0.") != std::string::npos;
  };
  CHECK(std::count_if(found.begin(), found.end(), tells) == 1);  // and of a gap
}

TEST_CASE("liquid that bodies take the place of is told by its volume", "[unit]") {
  const std::string bodies = R"([{"name": "a", "shape": {"box": {"low": [0.3, -0.1], "high": [0.5, 0.04]}}}])";
  CHECK(sentences_of(near_bodies(bodies)) ==
        std::vector<std::string>{"bodies take the place of 0.008 m^2 of the liquid, 8 %, which is cut away"});
}

TEST_CASE("check and run warn of bodies, and still run", "[scene]") {
  const Folder folder;
  Json scene = near_bodies(R"([{"name": "a", "shape": {"box": {"low": [0.02, 0.3], "high": [0.3, 0.5]}}}])");
  scene["time"] = Json::parse(R"({"end": 0.002, "step": 1e-3})");
  std::ofstream(folder / "a.json") << scene.dump();
  const auto checked = output_of_program(folder / "", {"check", "a.json"});
  CHECK(checked.code == 0);
  CHECK_THAT(checked.err, Contains("a.json: a gap of 0.02 m"));
  CHECK_THAT(checked.out, Contains("a.json: valid"));
  const auto ran = output_of_program(folder / "", {"run", "a.json", "--out", "out", "--threads", "1", "--quiet"});
  CHECK(ran.code == 0);
  CHECK_THAT(ran.err, Contains("a.json: a gap of 0.02 m"));
}

TEST_CASE("a mesh whose triangles turn inward is told once, by check and by run", "[scene]") {
  const Folder folder;
  const bool is_inward = GENERATE(true, false);
  std::ofstream(folder / "a.obj") << "v 0.2 0.2 0.3\nv 0.3 0.2 0.3\nv 0.2 0.3 0.3\nv 0.2 0.2 0.4\n"
                                  << (is_inward ? "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n"
                                                : "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  Json scene = around_bodies(R"([{"name": "a", "shape": {"mesh": {"file": "a.obj"}}}])");
  scene["time"] = Json::parse(R"({"end": 0.001, "step": 1e-3})");
  std::ofstream(folder / "a.json") << scene.dump();
  const auto checked = output_of_program(folder / "", {"check", "a.json"});
  CHECK(checked.code == 0);
  const std::string remark = "a.json: /bodies/0/shape/mesh/file: the triangles turn inward";
  const std::size_t found = checked.err.find(remark);
  CHECK((found != std::string::npos) == is_inward);
  if (is_inward) CHECK(checked.err.find(remark, found + 1) == std::string::npos);
  const auto ran = output_of_program(folder / "", {"run", "a.json", "--out", "out", "--threads", "1", "--quiet"});
  CHECK(ran.code == 0);
  CHECK((ran.err.find(remark) != std::string::npos) == is_inward);
}

TEST_CASE("a thin wall is told once, with its place, if it is wet on both sides", "[unit]") {
  const auto wall = [](double thickness) {
    return near_bodies(fmt::format(R"([{{"name": "wall", "shape": {{"box": {{"low": [0.5, -1], "high": [{}, 2]}}}}}}])",
                                   0.5 + thickness));
  };
  const auto of_wall = [](const Json& scene) {
    auto found = sentences_of(scene);
    found.erase(std::remove_if(found.begin(), found.end(),
                               [](const std::string& text) { return text.find("wet on both") == std::string::npos; }),
                found.end());
    return found;
  };
  const auto found = of_wall(wall(0.005));
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], Contains("body \"wall\" is 0.1 cells thick and wet on both sides at x = 0.5025, y = 0:"));
  CHECK_THAT(found[0], Contains("thicker than 0.0075 m, or cells of 0.0333 m"));
  CHECK(of_wall(wall(0.02)).empty());
  Json left = wall(0.005);
  left["particles"][0]["shape"]["box"]["high"][0] = 0.5;
  CHECK(of_wall(left).empty());
}
