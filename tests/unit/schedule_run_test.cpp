#include "components/types.hpp"
#include "engine/schedule/schedule.hpp"

#include <catch2/catch.hpp>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <utility>

using namespace minamo;

namespace {

struct LongName {
  static constexpr std::string_view name = "a table with a name too long for a short string";
};
struct OtherLongName {
  static constexpr std::string_view name = "another table with a name too long for a short string";
};
struct Left {
  int value = 0;
  static constexpr ComponentInfo info{"left", "l", "1", Lifetime::state};
};
struct Right {
  int value = 0;
  static constexpr ComponentInfo info{"right", "r", "1", Lifetime::state};
};

using Body = std::function<void()>;

template <class... Accesses>
System running(std::string name, Body body) {
  return {std::move(name),
          {Accesses::access()...},
          [](World& world) { ((void)Accesses(world), ...); },
          [body = std::move(body)](World&) { body(); }};
}

struct AddLeft {
  int amount = 1;
  void operator()(Update<Left> l) const { l->value += amount; }
};
struct CopyLeft {
  void operator()(Read<Left> l, Write<Right> r) const { r->value = l->value; }
};
struct ResizeBoth {
  void operator()(Resize<LongName> rows) const { rows.resize(rows.rows() + 1); }
};
struct ResizeOther {
  void operator()(Resize<OtherLongName> rows) const { rows.resize(rows.rows() + 1); }
};

struct TestPoints {
  static constexpr std::string_view name = "points";
};
struct PointPlace : Column<TestPoints, Vec<2>> {
  static constexpr ComponentInfo info{"point.place", "x", "m", Lifetime::state};
};
struct PointWeight : Column<TestPoints, double> {
  static constexpr ComponentInfo info{"point.weight", "w", "kg", Lifetime::state};
};
struct PointForce : Column<TestPoints, double> {
  static constexpr ComponentInfo info{"point.force", "f", "N", Lifetime::scratch};
};
struct WeighPoints {
  void operator()(Read<Left>, Read<PointPlace>, Update<PointWeight>, Write<PointForce>) const {}
};
struct SortPoints {
  void operator()(Resize<TestPoints>) const {}
};

const auto fails = [] { throw std::runtime_error("no"); };
const auto nothing = [] {};

Execution any_execution() { return GENERATE(Execution::graph, Execution::list); }

}  // namespace

TEST_CASE("a schedule creates the components of its systems", "[unit]") {
  World world;
  const Schedule schedule({make_system<CopyLeft>("copy")}, world);
  CHECK(world.has<Left>());
  CHECK(world.has<Right>());
}

TEST_CASE("a run of the first systems leaves out the others, and the next run has them again", "[unit]") {
  World world;
  Schedule schedule({make_system<AddLeft>("add"), make_system<CopyLeft>("copy"), make_system("more", AddLeft{10})},
                    world, nullptr, any_execution());
  schedule.run_first(1);
  CHECK(world.resource<Left>().value == 1);
  CHECK(world.resource<Right>().value == 0);
  schedule.run_first(2);
  CHECK(world.resource<Left>().value == 2);
  CHECK(world.resource<Right>().value == 2);
  schedule.run();
  CHECK(world.resource<Left>().value == 13);
}

TEST_CASE("a failure of the first systems comes out", "[unit]") {
  World world;
  Schedule schedule({running("fails", fails), running("other", nothing)}, world, nullptr, any_execution());
  CHECK_THROWS_WITH(schedule.run_first(1), "no");
  CHECK_NOTHROW(schedule.run_first(0));
}

TEST_CASE("every run runs every system once", "[unit]") {
  World world;
  Schedule schedule({make_system<AddLeft>("add"), make_system<CopyLeft>("copy"), make_system("more", AddLeft{10})},
                    world, nullptr, any_execution());
  schedule.run();
  schedule.run();
  CHECK(world.resource<Left>().value == 22);
  CHECK(world.resource<Right>().value == 12);
}

TEST_CASE("a schedule without systems runs", "[unit]") {
  World world;
  CHECK_NOTHROW(Schedule({}, world, nullptr, any_execution()).run());
}

TEST_CASE("a schedule can be moved between runs", "[unit]") {
  World world;
  Schedule first({make_system<AddLeft>("add")}, world);
  first.run();
  Schedule second = std::move(first);
  second.run();
  CHECK(world.resource<Left>().value == 2);
}

TEST_CASE("a schedule keeps the order of its list", "[unit]") {
  World world;
  const Schedule schedule({make_system<CopyLeft>("copy"), make_system<AddLeft>("add")}, world);
  REQUIRE(schedule.systems().size() == 2);
  CHECK(schedule.systems()[0].name == "copy");
}

TEST_CASE("a list runs in order on the calling thread", "[unit]") {
  World world;
  std::vector<std::pair<int, std::thread::id>> calls;
  const auto note = [&calls](int place) { calls.emplace_back(place, std::this_thread::get_id()); };
  Schedule schedule({running<>("a", [&] { note(0); }), running<>("b", [&] { note(1); })}, world, nullptr,
                    Execution::list);
  schedule.run();
  const auto here = std::this_thread::get_id();
  CHECK(calls == std::vector<std::pair<int, std::thread::id>>{{0, here}, {1, here}});
}

TEST_CASE("a schedule runs in the task arena of its caller", "[unit][threads]") {
  World world;
  int threads = 0;
  Schedule schedule({running<>("a", [&] { threads = tbb::this_task_arena::max_concurrency(); })}, world);
  tbb::task_arena arena(1);
  arena.execute([&] { schedule.run(); });
  CHECK(threads == 1);
}

TEST_CASE("different tables can be resized at the same time", "[unit][threads]") {
  World world;
  Schedule schedule({make_system<ResizeBoth>("rows"), make_system<ResizeOther>("other")}, world);
  for (int step = 0; step < 100; ++step) schedule.run();
  CHECK(world.rows<LongName>() == 100);
  CHECK(world.rows<OtherLongName>() == 100);
}

TEST_CASE("a system can run a schedule of its own", "[unit][threads]") {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    GENERATE(std::size_t{1}, std::size_t{2}));
  World world;
  Schedule inner({make_system<AddLeft>("add"), running<Read<Right>>("look", nothing)}, world);
  Schedule outer({running<Update<Left>>("repeat",
                                        [&] {
                                          for (int k = 0; k < 5; ++k) inner.run();
                                        }),
                  make_system<CopyLeft>("copy")},
                 world);
  outer.run();
  CHECK(world.resource<Right>().value == 5);
}

TEST_CASE("what a system throws comes out of the run", "[unit][error]") {
  World world;
  Schedule schedule({running<>("fails", fails)}, world, nullptr, any_execution());
  CHECK_THROWS_WITH(schedule.run(), "no");
}

TEST_CASE("systems that depend on a failed one do not run", "[unit][error]") {
  World world;
  Schedule schedule({running<Write<Left>>("fails", fails), make_system("add", AddLeft{1}),
                     make_system<CopyLeft>("copy"),
                     running<Update<Right>>("after", [&] { world.resource<Right>().value = 7; })},
                    world, nullptr, any_execution());
  CHECK_THROWS(schedule.run());
  CHECK(world.resource<Left>().value == 0);
  CHECK(world.resource<Right>().value == 0);
}

TEST_CASE("systems before a failed one have run", "[unit][error]") {
  World world;
  std::atomic<int> calls = 0;
  const auto count = [&calls] { ++calls; };
  Schedule schedule({running<>("a", count), running<>("b", count), running<>("c", count), running<>("fails", fails)},
                    world, nullptr, any_execution());
  CHECK_THROWS(schedule.run());
  CHECK(calls == 3);
}

TEST_CASE("of several failures the first of the list comes out", "[unit][error]") {
  World world;
  const auto slow_failure = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    throw std::runtime_error("first");
  };
  Schedule schedule({running<>("first", slow_failure), running<>("second", fails), running<>("third", fails)}, world,
                    nullptr, any_execution());
  CHECK_THROWS_WITH(schedule.run(), "first");
}

TEST_CASE("a schedule can be run again after a failure", "[unit][error]") {
  World world;
  bool healthy = false;
  Schedule schedule({make_system<AddLeft>("add"),
                     running<Update<Left>>("may_fail",
                                           [&] {
                                             if (!healthy) fails();
                                           }),
                     make_system<CopyLeft>("copy")},
                    world, nullptr, any_execution());
  CHECK_THROWS(schedule.run());
  healthy = true;
  CHECK_NOTHROW(schedule.run());
  CHECK(world.resource<Right>().value == 2);
}

TEST_CASE("a failure does not cut the parallel loops of other systems short", "[unit][error]") {
  World world;
  std::atomic<int> calls = 0;
  const auto loop = [&calls] {
    tbb::parallel_for(0, 64, [&calls](int) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      ++calls;
    });
  };
  Schedule schedule({running<>("loop", loop), running<>("fails", fails)}, world);
  CHECK_THROWS(schedule.run());
  CHECK(calls == 64);
}

TEST_CASE("the cancelling of an outer parallel algorithm does not leave a run half done", "[unit]") {
  World world;
  Schedule schedule({make_system<AddLeft>("add"), make_system<CopyLeft>("copy")}, world);
  tbb::task_group outer;
  outer.run_and_wait([&] {
    outer.cancel();
    schedule.run();
  });
  CHECK(world.resource<Right>().value == 1);
}

TEST_CASE("a profiler has a row per system in the order of the list", "[unit]") {
  World world;
  Profiler profiler;
  Schedule schedule({make_system<CopyLeft>("copy"), make_system<AddLeft>("add")}, world, &profiler, any_execution());
  schedule.run();
  schedule.run();
  const auto rows = profiler.rows();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].name == "copy");
  CHECK(rows[0].calls == 2);
  CHECK(rows[1].name == "add");
  CHECK(rows[1].calls == 2);
}

TEST_CASE("the profile knows how many bytes the columns have that systems declare", "[unit]") {
  World world;
  world.resize<TestPoints>(7);
  Profiler profiler;
  Schedule schedule({make_system<WeighPoints>("weigh"), make_system<SortPoints>("sort")}, world, &profiler,
                    Execution::list);
  world.resize<TestPoints>(10);
  schedule.run();
  schedule.run();
  REQUIRE(profiler.rows().size() == 2);
  // Read 16, read and written 8 each, written 8; resources count nothing. All that outlives a step, read and written.
  CHECK(profiler.rows()[0].bytes == 2 * 10 * (16 + 8 + 8 + 8));
  CHECK(profiler.rows()[1].bytes == 2 * 10 * 2 * (16 + 8));
}
