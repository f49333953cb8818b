#include "support/scene_run.hpp"

#include "components/matrix.hpp"
#include "engine/schedule/schedule.hpp"
#include "systems/scene/schemes.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A drop on the floor, which every volume correction and both solvers can move.
Json drop(const std::string& solver, double viscosity) {
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [8, 8]},
    "fluid": {"density": 1000}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0.25, 0], "high": [0.75, 0.5]}}, "velocity": [1, 0]}],
    "volume": {"scheme": "projection"}, "time": {"end": 1, "step": 0.01}})json");
  scene["solver"]["scheme"] = solver;
  scene["fluid"]["viscosity"] = viscosity;
  return scene;
}

std::vector<std::string> systems_of(const LinearSolver& solver) {
  std::vector<std::string> all = solver.prepare;
  all.insert(all.end(), solver.solve.begin(), solver.solve.end());
  all.insert(all.end(), solver.solve_volume.begin(), solver.solve_volume.end());
  return all;
}

}  // namespace

TEST_CASE("the second solve of a solver needs the systems that make its factors", "[property]") {
  const auto [own, other] = GENERATE(table<std::string, std::string>({{"block", "umfpack"}, {"umfpack", "block"}}));
  Json scene = drop(own, 1e-3);
  scene["systems"] = Json::array({Json{{"use", "solve_volume_" + other}, {"after", "volume"}}});
  CHECK_THROWS_WITH(SceneRun(scene), Catch::Contains("solve_volume_" + other + "\" reads solve."));
}

TEST_CASE("what a solver hands on is scratch of the matrix' rows, and work space nothing else", "[property]") {
  for (const LinearSolver& solver : registry().in_order<LinearSolver>()) {
    for (const std::string& name : systems_of(solver)) {
      for (const Access& access : registry().make(name, 2).access) {
        CAPTURE(name, access.component);
        if (!access.component.starts_with("solve.") || access.info->lifetime == Lifetime::state) continue;
        // Work space is not read by who does not write it first.
        if (access.info->lifetime == Lifetime::cache) CHECK(access.mode == Mode::update);
        if (access.info->lifetime == Lifetime::scratch) CHECK(access.table == ActiveNodes::name);
      }
    }
  }
}
