#include "support/scenes.hpp"

#include "components/cells.hpp"
#include "components/node.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

using State = std::map<std::string, std::vector<std::byte>>;

State after(const Json& scene, int steps, std::size_t threads, Execution execution) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  // Of its own, so that there may be more threads than the machine has cores.
  tbb::task_arena arena(static_cast<int>(threads));
  return arena.execute([&] {
    SceneRun run(scene, execution);
    run.step(steps);
    return state(run.world());
  });
}

/// Names of the components that differ in a bit.
std::vector<std::string> differences(const State& a, const State& b) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : a) {
    if (bytes != b.at(name)) names.push_back(name);
  }
  return names;
}

/// Small, but of several tasks in every loop: more than 2048 particles, 64 cells, 256 rows.
Json splash_3d() {
  return with(paper(scene_of_file("dam_break_3d.json")), {"/grid/cells=[12, 6, 12]", "/time/step=0.004"});
}

Json splash_2d() { return with(paper(scene_of_file("paper/dam_break_tpic.json")), {"/particles/0/per_cell=4"}); }

/// A splash of a scene that names no method, so that all are those of a user who does not choose: full cells, a
/// surface, and drops on their own.
template <int Dim>
struct Splash;

/// The dam break when its front has met the far wall.
template <>
struct Splash<2> {
  static constexpr int steps = 130;
  static Json scene() {
    Json scene = with(scene_of_file("dam_break.json"), {"/particles/0/per_cell=4", "/time/step=4e-3"});
    for (const char* method : {"discretization", "transfer", "integrator", "quadrature", "volume", "solver"}) {
      scene.erase(method);
    }
    return scene;
  }
};

/// A wide dam that breaks towards a near wall, while a drop and a single particle fall.
template <>
struct Splash<3> {
  static constexpr int steps = 22;
  static Json scene() {
    return Json::parse(R"({
      "dimension": 3, "grid": {"low": [0, 0, 0], "high": [1, 0.4, 1.2], "cells": [10, 4, 12]},
      "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, 0, -9.81],
      "particles": [
        {"shape": {"box": {"low": [0, 0, 0], "high": [0.8, 0.4, 0.7]}}, "per_cell": 3},
        {"shape": {"box": {"low": [0.85, 0.1, 1.0], "high": [0.9, 0.2, 1.1]}}, "per_cell": 2, "velocity": [0, 0, -2]},
        {"shape": {"box": {"low": [0.35, 0.21, 1.01], "high": [0.39, 0.25, 1.09]}}, "per_cell": 1}],
      "time": {"end": 1, "step": 0.008}})");
  }
};

/// The same between walls that the liquid may leave, under a body that goes up from it.
template <int Dim>
Json separating_splash() {
  Json scene = Splash<Dim>::scene();
  scene["walls"] = "separating";
  const Vec<Dim> low = Vec<Dim>::Constant(0.05) + (Dim == 2 ? 0.15 : 0.6) * Vec<Dim>::Unit(Dim - 1);
  const Vec<Dim> high = low + Vec<Dim>::Constant(0.11);
  Vec<Dim> up = 2 * Vec<Dim>::Unit(Dim - 1);
  const auto list = [](const Vec<Dim>& x) { return Json(std::vector<double>(x.begin(), x.end())); };
  scene["bodies"] = {{{"name", "lid"},
                      {"wall", "separating"},
                      {"shape", {{"box", {{"low", list(low)}, {"high", list(high)}}}}},
                      {"motion", {{"prescribed", {{"velocity", list(up)}}}}}}};
  return scene;
}

/// Particles with no other one in the dual cells around them.
template <int Dim>
std::size_t lone_particles(World& world) {
  const auto& cells = world.resource<OccupiedCells<Dim>>().cells;
  const auto is_near = [](const auto& a, const auto& b) {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (std::abs(a.node[d] - b.node[d]) > 1) return false;
    }
    return true;
  };
  std::size_t count = 0;
  for (const auto& cell : cells) {
    std::size_t around = 0;
    for (const auto& other : cells) around += is_near(cell, other) ? other.end - other.begin : 0;
    count += around == 1;
  }
  return count;
}

}  // namespace

TEST_CASE("one thread and two give the same bits in 2-D", "[verification][threads]") {
  const State one = after(splash_2d(), 50, 1, Execution::graph);
  const State two = after(splash_2d(), 50, 2, Execution::graph);
  CHECK(differences(one, two).empty());
}

TEST_CASE("the graph gives the bits of the list in 2-D", "[verification][threads]") {
  const State graph = after(splash_2d(), 50, 2, Execution::graph);
  const State list = after(splash_2d(), 50, 1, Execution::list);
  CHECK(differences(graph, list).empty());
}

TEST_CASE("one thread and two give the same bits in 3-D", "[verification][threads]") {
  const State one = after(splash_3d(), 10, 1, Execution::graph);
  const State two = after(splash_3d(), 10, 2, Execution::graph);
  CHECK(differences(one, two).empty());
}

TEST_CASE("the graph gives the bits of the list in 3-D", "[verification][threads]") {
  const State graph = after(splash_3d(), 10, 2, Execution::graph);
  const State list = after(splash_3d(), 10, 1, Execution::list);
  CHECK(differences(graph, list).empty());
}

TEMPLATE_TEST_CASE_SIG("a splash of a scene that names no method has spray, a surface and full cells",
                       "[verification][threads]", ((int Dim), Dim), 2, 3) {
  SceneRun run(of_equal_order(Splash<Dim>::scene()));
  run.step(Splash<Dim>::steps);
  const auto theta = run.world().template column<node::FilledIndicator>();
  CHECK(std::count(theta.begin(), theta.end(), 1) > 0);
  CHECK(std::count_if(theta.begin(), theta.end(), [](double share) { return share > 0 && share < 1; }) > 0);
  CHECK(lone_particles<Dim>(run.world()) > 0);
}

TEMPLATE_TEST_CASE_SIG(
    "such a splash is the same to the bit on one thread, two and three, by the graph and by the list",
    "[verification][threads][long]", ((int Dim), Dim), 2, 3) {
  const bool equal_order = GENERATE(false, true);
  CAPTURE(equal_order);
  const Json scene = equal_order ? of_equal_order(Splash<Dim>::scene()) : Splash<Dim>::scene();
  const auto splash = [&](std::size_t threads, Execution execution) {
    return after(scene, Splash<Dim>::steps, threads, execution);
  };
  const State one = splash(1, Execution::list);
  CHECK(differences(one, splash(1, Execution::graph)).empty());
  CHECK(differences(one, splash(2, Execution::graph)).empty());
  CHECK(differences(one, splash(3, Execution::graph)).empty());
  CHECK(differences(one, splash(3, Execution::list)).empty());
}

TEMPLATE_TEST_CASE_SIG("a splash between separating walls is the same to the bit on one thread and three",
                       "[verification][threads]", ((int Dim), Dim), 2, 3) {
  const Json scene = separating_splash<Dim>();
  const State one = after(scene, Splash<Dim>::steps, 1, Execution::list);
  const State three = after(scene, Splash<Dim>::steps, 3, Execution::graph);
  CHECK(differences(one, three).empty());
}
