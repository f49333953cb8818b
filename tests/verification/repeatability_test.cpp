#include "support/scenes.hpp"

#include <oneapi/tbb/global_control.h>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

using State = std::map<std::string, std::vector<std::byte>>;

State after(const Json& scene, int steps, std::size_t threads, Execution execution) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  SceneRun run(scene, execution);
  run.step(steps);
  return state(run.world());
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

}  // namespace

TEST_CASE("one thread and two give the same bits in the plane", "[verification][threads]") {
  const State one = after(splash_2d(), 50, 1, Execution::graph);
  const State two = after(splash_2d(), 50, 2, Execution::graph);
  CHECK(differences(one, two).empty());
}

TEST_CASE("the graph gives the bits of the list in the plane", "[verification][threads]") {
  const State graph = after(splash_2d(), 50, 2, Execution::graph);
  const State list = after(splash_2d(), 50, 1, Execution::list);
  CHECK(differences(graph, list).empty());
}

TEST_CASE("one thread and two give the same bits in space", "[verification][threads]") {
  const State one = after(splash_3d(), 10, 1, Execution::graph);
  const State two = after(splash_3d(), 10, 2, Execution::graph);
  CHECK(differences(one, two).empty());
}

TEST_CASE("the graph gives the bits of the list in space", "[verification][threads]") {
  const State graph = after(splash_3d(), 10, 2, Execution::graph);
  const State list = after(splash_3d(), 10, 1, Execution::list);
  CHECK(differences(graph, list).empty());
}
