#include "engine/schedule/schedule.hpp"

#include "support/rows.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::rows;

namespace {

struct Seen {
  bool slope = false;
  bool height = false;
  bool factor = false;
  double sum = 0;
  static constexpr ComponentInfo info{"seen", "", "m", Lifetime::state};
};

struct Factor {
  double value = 3;
  static constexpr ComponentInfo info{"factor", "", "1", Lifetime::constant};
};

struct LookAround {
  void operator()(Optional<Read<Slope>> s, Optional<Read<Height>> h, Optional<Read<Factor>> f, Write<Seen> seen) const {
    *seen = {bool(s), bool(h), bool(f), 0};
    for (const double slope : s.span()) seen->sum += (f ? f->value : 1) * slope;
  }
};

struct SetSlope {
  void operator()(Write<Slope> s) const {
    for (double& slope : s) slope = 1;
  }
};

Seen seen_by(std::vector<System> systems, World& world) {
  Schedule(std::move(systems), world).run();
  return world.resource<Seen>();
}

}  // namespace

TEST_CASE("an optional component is not created for its reader", "[unit]") {
  World world;
  const Seen seen = seen_by({make_system<LookAround>("look")}, world);
  CHECK_FALSE(seen.slope);
  CHECK_FALSE(seen.height);
  CHECK_FALSE(world.has<Slope>());
  CHECK_FALSE(world.has<Height>());
}

TEST_CASE("an optional component is read where an earlier system writes it", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  const Seen seen = seen_by({make_system<SetSlope>("set"), make_system<LookAround>("look")}, world);
  CHECK(seen.slope);
  CHECK(seen.sum == 3);
}

TEST_CASE("an optional component that outlives a step is read where the world has it", "[unit]") {
  World world = world_with_heights({1});
  world.resource<Factor>();
  const Seen seen = seen_by({make_system<LookAround>("look")}, world);
  CHECK(seen.height);
  CHECK(seen.factor);
}

TEST_CASE("scratch that another list has written is absent from a list that does not write it", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  Schedule({make_system<SetSlope>("set")}, world).run();
  REQUIRE(world.has<Slope>());
  CHECK_FALSE(seen_by({make_system<LookAround>("look")}, world).slope);
}

TEST_CASE("an optional read before the only writer is refused", "[unit]") {
  const std::vector<System> systems{make_system<LookAround>("look"), make_system<SetSlope>("set")};
  CHECK(unwritten_reads(systems) ==
        std::vector<std::string>{"system \"look\" reads row.slope, which only a later system of the step writes"});
}

TEST_CASE("a graph does not show what is absent", "[unit]") {
  const auto systems = without_absent({make_system<LookAround>("look")});
  REQUIRE(systems.front().access.size() == 3);
  CHECK(systems.front().access[0].component == "row.height");
}

TEST_CASE("an optional read waits for its writer", "[unit]") {
  const std::vector<System> systems{make_system<SetSlope>("set"), make_system<LookAround>("look")};
  CHECK(derive_edges(systems) == std::vector<Edge>{{0, 1}});
}
