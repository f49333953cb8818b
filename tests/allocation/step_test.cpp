/// \file
/// A step does not ask the heap for memory once the run is warm. A table that grows beyond what it has ever held has
/// to: in these steps of a dam break no node becomes active that was not at the start. SuiteSparse makes its factors
/// anew by malloc(), which is left out here.

#include "allocation/counting.hpp"
#include "engine/run/clock.hpp"
#include "support/folder.hpp"
#include "support/scene_run.hpp"
#include "systems/output/history.hpp"
#include "tools/program/scene_file.hpp"

#include <catch2/catch.hpp>
#include <oneapi/tbb/global_control.h>

#include <cstdlib>
#include <map>

using namespace minamo;
using allocation::Count;

namespace {

constexpr int first_step = 11;
constexpr int last_step = 20;

struct Counts {
  std::map<std::string, Count> of_system;
  Count of_steps;  ///< systems and what runs them
};

/// The system, which adds what it asks for to `count`.
System counted(System system, Count& count) {
  system.run = [run = std::move(system.run), &count](World& world) {
    const Count before = allocation::count();
    run(world);
    count += allocation::count() - before;
  };
  return system;
}

void run_step(Schedule& step, World& world) {
  auto& clock = world.resource<Clock>();
  clock.end_of_step = static_cast<double>(clock.index + 1) * clock.step;
  step.run();
  clock.time = clock.end_of_step;
  ++clock.index;
}

/// Of steps 11 to 20, on one thread, with a history.
Counts count_allocations(const Json& json, Execution execution = Execution::list) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Folder folder;
  const Scene scene = scene_run::read(json);
  World world;
  seed(scene, "scene.json", world);
  world.resource<HistoryFile>().file.open(folder / "history.csv");
  Pipeline pipeline = make_pipeline(scene);
  Counts counts;
  std::vector<System> systems;
  for (System& system : pipeline.step) {
    const std::string name = system.name;
    systems.push_back(counted(std::move(system), counts.of_system[name]));
  }
  Schedule start(std::move(pipeline.start), world);
  Schedule step(std::move(systems), world, nullptr, execution);
  world.resource<Clock>().step = scene.time.step.value();
  start.run();
  for (int k = 1; k < first_step; ++k) run_step(step, world);
  for (auto& [name, count] : counts.of_system) count = {};
  const Count before = allocation::count();
  for (int k = first_step; k <= last_step; ++k) run_step(step, world);
  counts.of_steps = allocation::count() - before;
  return counts;
}

bool is_solver(const std::string& name) { return name.starts_with("solve_") || name.starts_with("factorize_"); }

Json dam_break(const std::vector<std::string>& overrides) {
  const Json scene = scene_run::with(
      scene_run::scene_of_file("paper/dam_break_tpic.json"),
      {R"(/transfer={"scheme":"tpic"})", R"(/integrator={"scheme":"midpoint"})", R"(/volume={"scheme":"projection"})"});
  return scene_run::with(scene, overrides);
}

}  // namespace

TEST_CASE("operator new and malloc are counted", "[property]") {
  const Count before = allocation::count();
  // Volatile: what nobody looks at need not be allocated.
  auto* volatile by_new = new double[1000];
  void* volatile by_malloc = std::malloc(1000);  // NOLINT(cppcoreguidelines-no-malloc)
  const Count added = allocation::count() - before;
  delete[] by_new;
  std::free(by_malloc);  // NOLINT(cppcoreguidelines-no-malloc)
  CHECK(added == Count{.by_new = 1, .by_malloc = 1});
}

TEST_CASE("a step allocates nothing after the first ones", "[property]") {
  const auto overrides = GENERATE(values<std::vector<std::string>>({
      {},
      {R"(/fluid/viscosity=0)"},
      {R"(/volume={"scheme":"delta"})"},
      {R"(/transfer={"scheme":"pic"})"},
      {R"(/transfer={"scheme":"flip"})", R"(/integrator={"scheme":"newmark"})"},
      {R"(/integrator={"scheme":"newmark"})"},
      {R"(/transfer={"scheme":"apic"})", R"(/integrator={"scheme":"newmark"})"},
      {R"(/transfer={"scheme":"tpic2"})"},
      {R"(/transfer={"scheme":"xpic"})"},
      {R"(/transfer={"scheme":"fmpm"})"},
      {R"(/stabilization={"scheme":"oss"})"},
      {R"(/stabilization={"scheme":"vms"})"},
      {R"(/solver={"scheme":"umfpack"})"},
      {R"(/body_force=["-0.1*x", -9.81])"},
      {R"(/ode={"A":{"start":1,"rate":"-A"}})", R"(/body_force=["-0.1*A*x", -9.81])"},
      {R"(/exact={"velocity":["x","-y"],"pressure":"y"})", R"(/probes=[{"name":"P","at":[0.1,0.1]}])"},
  }));
  CAPTURE(overrides);
  for (const auto& [name, count] : count_allocations(dam_break(overrides)).of_system) {
    if (is_solver(name)) continue;
    CAPTURE(name);
    CHECK(count == Count{});
  }
}

TEST_CASE("a solver makes no vectors after the first steps, whatever the size", "[property]") {
  const std::string solver = GENERATE("block", "umfpack");
  const auto [cells, step] = GENERATE(table<int, std::string>({{40, "1e-3"}, {80, "5e-4"}}));
  const std::string count_of_cells = std::to_string(cells);
  CAPTURE(solver, cells);
  const auto counts = count_allocations(
      dam_break({R"(/solver={"scheme":")" + solver + R"("})",
                 "/grid/cells=[" + count_of_cells + "," + count_of_cells + "]", "/time/step=" + step}));
  for (const auto& [name, count] : counts.of_system) {
    if (!is_solver(name)) continue;
    CAPTURE(name);
    CHECK(count.by_new == 0);
  }
}

TEST_CASE("running the systems allocates nothing", "[property]") {
  const auto execution = GENERATE(Execution::list, Execution::graph);
  auto [of_system, left] = count_allocations(dam_break({}), execution);
  for (const auto& [name, count] : of_system) left = left - count;
  CHECK(left == Count{});
}
