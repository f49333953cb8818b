#include "support/rows.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

using namespace minamo;
using namespace minamo::rows;

namespace {

struct Total {
  double value = 0;
  static constexpr ComponentInfo info{"total", "T", "m", Lifetime::state};
};

struct SumUp {
  double factor = 1;
  void operator()(Read<Height> h, Write<Slope> s, Update<Total> T) const {
    for (std::size_t row = 0; row < h.size(); ++row) {
      s[row] = factor * h[row];
      T->value += s[row];
    }
  }
};

/// What two systems have together.
struct HeightAndTotal {
  Read<Height> h;
  Optional<Read<Total>> T;
  Write<Slope> s;
};

struct SlopeOfTotal {
  void operator()(Uses<HeightAndTotal> of, Update<Depth> d) const {
    for (std::size_t row = 0; row < of.h.size(); ++row) of.s[row] = of.h[row] + (of.T ? of.T->value : 100);
    for (double& value : d) value = 1;
  }
};

struct Grow {
  void operator()(Resize<Rows> rows, Update<Height> h) const {
    rows.resize(rows.rows() + 2);
    for (double& value : h) value += 1;
  }
};

struct Reverse {
  void operator()(Resize<Rows> rows) const {
    std::vector<std::uint32_t> order(rows.rows());
    for (std::size_t row = 0; row < order.size(); ++row)
      order[row] = static_cast<std::uint32_t>(order.size() - 1 - row);
    rows.reorder(order);
  }
};

}  // namespace

TEST_CASE("the declaration of a system is its parameters in their order", "[unit]") {
  const System system = make_system<SumUp>("sum_up");
  REQUIRE(system.access.size() == 3);
  CHECK(system.access[0].mode == Mode::read);
  CHECK(system.access[0].component == "row.height");
  CHECK(system.access[1].mode == Mode::write);
  CHECK(system.access[1].component == "row.slope");
  CHECK(system.access[2].mode == Mode::update);
  CHECK(system.access[2].component == "total");
}

TEST_CASE("a bundle declares all of its views, in its place among the parameters", "[unit]") {
  const System system = make_system<SlopeOfTotal>("slope_of_total");
  REQUIRE(system.access.size() == 4);
  CHECK(system.access[0].component == "row.height");
  CHECK(system.access[0].mode == Mode::read);
  CHECK(system.access[1].component == "total");
  CHECK(system.access[1].optional);
  CHECK(system.access[2].component == "row.slope");
  CHECK(system.access[2].mode == Mode::write);
  CHECK(system.access[3].component == "other.depth");
  CHECK(system.access[3].mode == Mode::update);
}

TEST_CASE("a bundle has the views, and optional ones only where they are there", "[unit]") {
  World world;
  const System system = make_system<SlopeOfTotal>("slope_of_total");
  system.prepare(world);
  world.resize<Rows>(2);
  world.column<Height>()[1] = 3;
  system.run(world);
  CHECK(world.column<Slope>()[0] == 100);
  CHECK(world.column<Slope>()[1] == 103);
  world.resource<Total>().value = 5;
  system.run(world);
  CHECK(world.column<Slope>()[1] == 8);
  system.without({"total"}).run(world);
  CHECK(world.column<Slope>()[1] == 103);
}

TEST_CASE("a column's declaration names its table and its info", "[unit]") {
  const Access access = Read<Height>::access();
  CHECK(access.table == "row");
  CHECK(access.info == &Height::info);
}

TEST_CASE("a resource's declaration names no table", "[unit]") { CHECK(Write<Total>::access().table.empty()); }

TEST_CASE("a resize declares the table and no component", "[unit]") {
  const Access access = Resize<Rows>::access();
  CHECK(access.mode == Mode::resize);
  CHECK(access.table == "row");
  CHECK(access.component.empty());
  CHECK(access.info == nullptr);
}

TEST_CASE("what is only read is const", "[unit]") {
  STATIC_REQUIRE(std::is_same_v<decltype(std::declval<Read<Height>>()[0]), const double&>);
  STATIC_REQUIRE(std::is_same_v<decltype(std::declval<Read<Height>>().span()), std::span<const double>>);
  STATIC_REQUIRE(std::is_same_v<decltype(*std::declval<Read<Total>>()), const Total&>);
}

TEST_CASE("prepare creates every component that a system names", "[unit]") {
  World world;
  make_system<SumUp>("sum_up").prepare(world);
  CHECK(world.has<Height>());
  CHECK(world.has<Slope>());
  CHECK(world.has<Total>());
}

TEST_CASE("a system runs its kernel on the world's components", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  make_system<SumUp>("sum_up").run(world);
  CHECK(values(world.column<Slope>()) == std::vector<double>{1, 2, 3});
  CHECK(world.resource<Total>().value == 6);
}

TEST_CASE("a system keeps the parameters of its kernel", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  make_system("sum_up", SumUp{.factor = 10}).run(world);
  CHECK(world.resource<Total>().value == 60);
}

TEST_CASE("a view follows its table when the system itself resizes it", "[unit]") {
  World world = world_with_heights({1, 2});
  make_system<Grow>("grow").run(world);
  CHECK(values(world.column<Height>()) == std::vector<double>{2, 3, 1, 1});
}

TEST_CASE("the right to resize includes the right to reorder", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  make_system<Reverse>("reverse").run(world);
  CHECK(values(world.column<Height>()) == std::vector<double>{3, 2, 1});
}
