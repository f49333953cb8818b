/// \file
/// What is said of a scene before it runs because it may not be meant, and that nothing is said of the scenes here.

#include "support/folder.hpp"
#include "support/program_output.hpp"
#include "support/scene_run.hpp"
#include "systems/scene/time_counts.hpp"
#include "systems/step/scene_doubts.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using Catch::Matchers::Contains;

namespace {

/// A dam break in a box of that many metres.
Json dam_break_of(double extent, double end, int dimension = 2) {
  Json scene = Json::parse(R"({"fluid": {"density": 1000, "viscosity": 1e-3}})");
  const auto d = static_cast<std::size_t>(dimension);
  scene["dimension"] = dimension;
  scene["grid"] = {
      {"low", std::vector<double>(d, 0)}, {"high", std::vector<double>(d, extent)}, {"cells", std::vector<int>(d, 8)}};
  scene["body_force"] = std::vector<double>(d, 0);
  scene["body_force"][d - 1] = -9.81;
  scene["particles"] = Json::array(
      {{{"shape", {{"box", {{"low", std::vector<double>(d, 0)}, {"high", std::vector<double>(d, extent / 2)}}}}}}});
  scene["time"] = {{"end", end}, {"step", end / 100}};
  return scene;
}

std::vector<std::string> doubts_of_lengths(const Json& scene) { return warnings_of_lengths(scene_run::read(scene)); }

std::vector<std::string> doubts_of_speeds(const Json& scene) {
  scene_run::SceneRun run(scene);
  return warnings_of_speeds(run.scene(), run.world());
}

std::vector<std::string> remarks_of(const Json& scene) {
  return understand_scene(scene, "a.json", scene_run::registry()).scene.remarks;
}

}  // namespace

TEST_CASE("a box in millimetres that was given in metres is told by the time that its fall takes", "[unit]") {
  const int dimension = GENERATE(2, 3);
  const auto doubts = doubts_of_lengths(dam_break_of(584, 5, dimension));
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], Contains("in 5 s a body force of 9.81 m/s^2 hardly moves what is as large as the box, 584 m "
                                 "along the force, which takes 7.72 s: lengths are in metres"));
}

TEST_CASE("a large box that is given its time is not doubted, nor is a small one, nor a drop", "[unit]") {
  const auto [extent, end] =
      GENERATE(table<double, double>({{584, 50}, {40, 1}, {0.584, 5}, {0.584, 1e-3}, {3e-5, 1e-6}}));
  CAPTURE(extent, end);
  CHECK(doubts_of_lengths(dam_break_of(extent, end)).empty());
}

TEST_CASE("a long flume is measured along the force, and without gravity nothing falls", "[unit]") {
  Json flume = dam_break_of(584, 5);
  flume["grid"] = Json::parse(R"({"low": [0, 0], "high": [200, 5], "cells": [200, 5]})");
  flume["particles"][0]["shape"]["box"]["high"] = {100, 2};
  CHECK(doubts_of_lengths(flume).empty());
  Json still = dam_break_of(584, 5);
  still["body_force"] = {0, 0};
  CHECK(doubts_of_lengths(still).empty());
}

TEST_CASE("gravity in mm/s^2 and cm/s^2 is told", "[unit]") {
  const auto [b, unit] = GENERATE(table<double, std::string>({{-9810, "mm"}, {-9806.65, "mm"}, {-981, "cm"}}));
  Json scene = dam_break_of(1, 1);
  scene["body_force"] = {0, b};
  const auto doubts = doubts_of_lengths(scene);
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], Contains("looks like gravity in " + unit + "/s^2"));
  scene["body_force"] = {0, -500};  // of a centrifuge
  CHECK(doubts_of_lengths(scene).empty());
}

TEST_CASE("a drop in millimetres that was given in metres is told by the time of its tension", "[unit]") {
  const auto with_tension = [](double extent, double end) {
    Json scene = dam_break_of(extent, end);
    scene["body_force"] = {0, 0};
    scene["surface_tension"] = {{"coefficient", 0.072}};
    return scene;
  };
  const auto doubts = doubts_of_lengths(with_tension(5, 0.05));
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], Contains("a surface tension of 0.072 N/m does not move what is as large as the box, 5 m"));
  CHECK(doubts_of_lengths(with_tension(5e-3, 0.05)).empty());
  CHECK(doubts_of_lengths(with_tension(3e-5, 1e-5)).empty());
  CHECK(doubts_of_lengths(with_tension(1, 5)).empty());
}

TEST_CASE("a speed that no liquid has is told: of the liquid, a body, an inflow", "[unit]") {
  Json scene = dam_break_of(1, 1);
  CHECK(doubts_of_speeds(scene).empty());
  scene["particles"][0]["velocity"] = {"1e6*x", 0};
  scene["bodies"] = Json::parse(R"([{"name": "hammer", "shape": {"ball": {"center": [0.8, 0.8], "radius": 0.1}},
                                     "motion": {"prescribed": {"velocity": [0, "-2e4*t"]}}}])");
  scene["openings"] = Json::parse(R"([{"name": "jet", "side": "x_high", "inflow": {"velocity": ["-2000*y", 0]}}])");
  const auto doubts = doubts_of_speeds(scene);
  REQUIRE(doubts.size() == 3);
  CHECK_THAT(doubts[0], Contains("the liquid starts at 4.792e+05 m/s, faster than sound in water"));
  CHECK_THAT(doubts[1], Contains("body \"hammer\" moves at 2e+04 m/s"));
  CHECK_THAT(doubts[2], Contains("liquid comes in through \"jet\" at 2000 m/s"));
}

TEST_CASE("a step longer than the run, frames of every step and very many steps are told", "[unit]") {
  const auto remarks_with = [](const std::string& time, const std::string& output) {
    Json scene = dam_break_of(1, 1);
    scene["time"] = Json::parse(time);
    scene["output"] = Json::parse(output);
    return remarks_of(scene);
  };
  using Remarks = std::vector<std::string>;
  CHECK(remarks_with(R"({"end": 1, "step": 0.01})", R"({"every": 0.01})").empty());
  CHECK(remarks_with(R"({"end": 1, "step": 0.1})", "{}").empty());  // frames are due every 0.02 s by default
  CHECK(remarks_with(R"({"end": 1, "step": 2})", R"({"every": 2})") ==
        Remarks{"/time/step: 2 s is longer than the run, which is one step of 1 s"});
  CHECK(remarks_with(R"({"end": 1, "step": 0.01})", R"({"every": 1e-9})") ==
        Remarks{"/output/every: 1e-09 s is shorter than a step, 0.01 s: every step has a frame, 101 in all"});
  CHECK(remarks_with(R"({"end": 1, "step": 5e-8})", "{}") == Remarks{"/time/step: 2e+07 steps up to the end at 1 s"});
}

TEST_CASE("steps and frames are counted as a run takes them", "[unit]") {
  const auto [end, step, every, steps, frames] = GENERATE(table<double, double, double, double, double>(
      {{1, 0.01, 0.1, 100, 11}, {1, 0.3, 0.3, 4, 5}, {0.3, 0.1, 0.1, 3, 4}, {1, 0.1, 5, 10, 2}, {1, 2, 1, 1, 2}}));
  CAPTURE(end, step, every);
  CHECK(steps_of({.end = end, .step = step, .cfl = 0, .max_step = {}}) == steps);
  CHECK(frames_of({.end = end, .step = step, .cfl = 0, .max_step = {}},
                  {.every = every, .checkpoint = {}, .history = 1, .surface = "none"}) == frames);
}

TEST_CASE("no length and no time of the scenes here is doubted", "[unit]") {
  const std::filesystem::path scenes = std::string(MINAMO_SOURCE_DIR) + "/scenes";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes)) {
    if (entry.path().extension() != ".json") continue;
    const Json json = read_json(entry.path());
    if (!json.is_object() || !json.contains("grid") || !json.contains("time")) continue;
    CAPTURE(entry.path().string());
    const SceneFile file = understand_scene(json, entry.path(), scene_run::registry());
    CHECK(file.scene.remarks.empty());
    CHECK(warnings_of_lengths(file.scene).empty());
  }
}
