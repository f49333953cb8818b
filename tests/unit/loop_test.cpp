#include "engine/schedule/loop.hpp"

#include "engine/run/step_control.hpp"
#include "engine/schedule/schedule.hpp"
#include "support/rows.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;
using namespace minamo::rows;

namespace {

struct Root {
  double value = 0;
  static constexpr ComponentInfo info{"root", "x", "1", Lifetime::state};
};

struct Change {
  double value = 0;
  static constexpr ComponentInfo info{"change", "dx", "1", Lifetime::scratch};
};

struct Newton : LoopControl {
  static constexpr ComponentInfo info{"newton", "k", "1", Lifetime::scratch};
};

/// x^2 = 2.
struct FindChange {
  void operator()(Read<Root> x, Write<Change> dx) const { dx->value = (2 - x->value * x->value) / (2 * x->value); }
};
struct ApplyChange {
  void operator()(Read<Change> dx, Update<Root> x, Update<Newton> newton) const {
    x->value += dx->value;
    newton->enough = std::abs(dx->value) < 1e-12;
  }
};

System newton_loop(int most_passes) {
  return make_loop<Newton>("newton", {make_system<FindChange>("find"), make_system<ApplyChange>("apply")}, most_passes);
}

struct ReadChange {
  void operator()(Read<Change>) const {}
};

}  // namespace

TEST_CASE("a loop repeats its systems until one of them says that it is enough", "[unit]") {
  const auto execution = GENERATE(Execution::graph, Execution::list);
  World world;
  world.resource<Root>().value = 1;
  Schedule schedule({newton_loop(20)}, world, nullptr, execution);
  schedule.run();
  CHECK(world.resource<Root>().value == Approx(std::sqrt(2)).epsilon(1e-14));
  CHECK(world.resource<Newton>().pass == 5);
}

TEST_CASE("a loop can be run again and counts its passes anew", "[unit]") {
  World world;
  world.resource<Root>().value = 1;
  Schedule schedule({newton_loop(20)}, world);
  schedule.run();
  schedule.run();
  CHECK(world.resource<Newton>().pass == 0);
}

TEST_CASE("a loop that is never enough rejects the step", "[unit]") {
  World world;
  world.resource<Root>().value = 1;
  Schedule schedule({newton_loop(2)}, world);
  CHECK_THROWS_AS(schedule.run(), StepRejected);
  CHECK_THROWS_WITH(schedule.run(), "newton: not enough after 2 passes");
}

TEST_CASE("what a loop has changed is taken back with the step", "[unit]") {
  World world;
  world.resource<Root>().value = 1;
  Schedule schedule({newton_loop(20)}, world);
  world.mark();
  schedule.run();
  world.roll_back();
  CHECK(world.resource<Root>().value == 1);
}

TEST_CASE("a loop declares what its body does, as one system", "[unit]") {
  const System loop = newton_loop(20);
  const auto mode_of = [&](std::string_view component) {
    const auto found = std::find_if(loop.access.begin(), loop.access.end(),
                                    [&](const Access& access) { return access.component == component; });
    REQUIRE(found != loop.access.end());
    return found->mode;
  };
  CHECK(mode_of("root") == Mode::update);
  CHECK(mode_of("change") == Mode::write);
  CHECK(mode_of("newton") == Mode::write);
  const std::vector<System> systems{loop, make_system<ReadChange>("read")};
  CHECK(unwritten_reads(systems).empty());
  CHECK(derive_edges(systems) == std::vector<Edge>{{0, 1}});
}

TEST_CASE("a loop whose body reads scratch that nobody writes is refused", "[unit]") {
  const std::vector<System> systems{make_loop<Newton>("loop", {make_system<ReadChange>("read")}, 3)};
  CHECK(unwritten_reads(systems) ==
        std::vector<std::string>{"system \"loop\" reads change, which no earlier system of the step writes"});
}

TEST_CASE("every system of a loop has a row in the profile, with a call per pass", "[unit]") {
  World world;
  world.resource<Root>().value = 1;
  Profiler profiler;
  Schedule schedule({newton_loop(20)}, world, &profiler);
  schedule.run();
  const auto rows = profiler.rows();
  REQUIRE(rows.size() == 3);
  CHECK(rows[1].name == "newton / find");
  CHECK(rows[1].calls == 6);
  CHECK(rows[2].name == "newton / apply");
  CHECK(rows[2].calls == 6);
}
