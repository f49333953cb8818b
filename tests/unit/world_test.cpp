#include "engine/storage/world.hpp"

#include "support/rows.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

using namespace minamo;
using namespace minamo::rows;

namespace {

struct Stress : Column<Rows, Eigen::Matrix<double, 3, 3, Eigen::DontAlign>> {
  static constexpr ComponentInfo info{"row.stress", "σ", "Pa", Lifetime::state};
};
struct Colour : Column<Rows, double> {
  static constexpr ComponentInfo info{"row.colour", "", "1", Lifetime::constant};
};
struct Label : Column<Rows, std::string> {
  static constexpr ComponentInfo info{"row.label", "l", "1", Lifetime::state};
};
struct Amount {
  double value = 3;
  static constexpr ComponentInfo info{"total", "T", "1", Lifetime::state};
};
struct SameNameAsAmount {
  int value = 0;
  static constexpr ComponentInfo info{"total", "T", "1", Lifetime::state};
};

struct Padded {
  double value = 3;
  bool is_set = true;
  static constexpr ComponentInfo info{"padded", "P", "1", Lifetime::state};
};

/// As a system changes a value.
void update(World& world, std::size_t row, double height) {
  const Update<Height> h(world);
  h[row] = height;
}

}  // namespace

TEST_CASE("a column made after its table was resized has the table's rows", "[unit]") {
  World world;
  world.resize<Rows>(5);
  CHECK(world.column<Height>().size() == 5);
}

TEST_CASE("a column made before its table is resized follows it", "[unit]") {
  World world;
  CHECK(world.column<Height>().empty());
  world.resize<Rows>(5);
  CHECK(world.column<Height>().size() == 5);
}

TEST_CASE("a new column of matrices is zero", "[unit]") {
  World world;
  world.resize<Rows>(4);
  for (const auto& stress : world.column<Stress>()) CHECK(stress == Stress::value_type::Zero());
}

TEST_CASE("growing a table keeps the old rows and adds zeros", "[unit]") {
  World world = world_with_heights({1, 2});
  world.resize<Rows>(4);
  CHECK(values(world.column<Height>()) == std::vector<double>{1, 2, 0, 0});
}

TEST_CASE("shrinking a table keeps the first rows", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  world.resize<Rows>(2);
  CHECK(values(world.column<Height>()) == std::vector<double>{1, 2});
}

TEST_CASE("rows that come back after a table shrank are zero", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  world.resize<Rows>(1);
  world.resize<Rows>(3);
  CHECK(values(world.column<Height>()) == std::vector<double>{1, 0, 0});
}

TEST_CASE("a resize leaves other tables alone", "[unit]") {
  World world;
  world.resize<OtherRows>(2);
  CHECK(world.column<Depth>().size() == 2);
  world.resize<Rows>(7);
  CHECK(world.column<Depth>().size() == 2);
}

TEST_CASE("an unknown table has no rows", "[unit]") { CHECK(World().rows<Rows>() == 0); }

TEST_CASE("making a known table known again keeps its rows", "[unit]") {
  World world = world_with_heights({1, 2});
  world.add_table<Rows>();
  CHECK(world.rows<Rows>() == 2);
}

TEST_CASE("after a reorder row k is what row order[k] was", "[unit]") {
  World world = world_with_heights({10, 11, 12, 13});
  Resize<Rows>(world).reorder(std::array<std::uint32_t, 4>{2, 0, 3, 1});
  CHECK(values(world.column<Height>()) == std::vector<double>{12, 10, 13, 11});
}

TEST_CASE("a reorder leaves scratch as it is", "[unit]") {
  World world = world_with_heights({10, 11});
  world.column<Slope>()[0] = 5;
  Resize<Rows>(world).reorder(std::array<std::uint32_t, 2>{1, 0});
  CHECK(values(world.column<Slope>()) == std::vector<double>{5, 0});
}

TEST_CASE("a second reorder of the same length moves no array to new memory", "[unit]") {
  World world = world_with_heights({10, 11});
  const std::array<std::uint32_t, 2> order{1, 0};
  const double* first = world.column<Height>().data();
  Resize<Rows>(world).reorder(order);
  Resize<Rows>(world).reorder(order);
  CHECK(world.column<Height>().data() == first);
}

TEST_CASE("after a renumbering row k is what row from[k] was, and zero where there was none", "[unit]") {
  World world = world_with_heights({10, 11, 12});
  world.renumber<Rows>(std::array<std::optional<std::uint32_t>, 4>{std::nullopt, 2, 0, std::nullopt});
  CHECK(values(world.column<Height>()) == std::vector<double>{0, 12, 10, 0});
  CHECK(world.rows<Rows>() == 4);
}

TEST_CASE("a renumbering gives scratch the new number of rows", "[unit]") {
  World world = world_with_heights({10, 11, 12});
  world.column<Slope>();
  world.renumber<Rows>(std::array<std::optional<std::uint32_t>, 2>{1, 2});
  CHECK(world.column<Slope>().size() == 2);
}

TEST_CASE("a renumbering leaves other tables alone", "[unit]") {
  World world = world_with_heights({10, 11});
  world.resize<OtherRows>(5);
  world.renumber<Rows>(std::array<std::optional<std::uint32_t>, 1>{1});
  CHECK(world.column<Depth>().size() == 5);
}

TEST_CASE("a resource starts with its default", "[unit]") {
  World world;
  CHECK(world.resource<Amount>().value == 3);
}

TEST_CASE("a resource keeps what was written to it", "[unit]") {
  World world;
  world.resource<Amount>().value = 7;
  CHECK(world.resource<Amount>().value == 7);
}

TEST_CASE("two types with one component name are refused", "[unit][error]") {
  World world;
  world.resource<Amount>();
  CHECK_THROWS_WITH(world.resource<SameNameAsAmount>(),
                    Catch::StartsWith("component \"total\" is defined by two types"));
}

TEST_CASE("a component exists from its first use on", "[unit]") {
  World world;
  CHECK_FALSE(world.has<Height>());
  world.column<Height>();
  CHECK(world.has<Height>());
}

TEST_CASE("components are listed by name", "[unit]") {
  World world;
  world.column<Height>();
  world.resource<Amount>();
  std::vector<std::string> names;
  for (const auto& [name, storage] : world.components()) names.push_back(name);
  CHECK(names == std::vector<std::string>{"row.height", "total"});
}

TEST_CASE("the bytes of a column are its values", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  const auto bytes = world.storage<Height>().bytes();
  CHECK(static_cast<const void*>(bytes.data()) == world.column<Height>().data());
  CHECK(bytes.size() == 3 * sizeof(double));
}

TEST_CASE("a matrix column is known to be made of doubles", "[unit]") {
  World world;
  CHECK(world.storage<Stress>().doubles_per_value() == 9);
  CHECK(world.storage<Stress>().value_bytes() == 9 * sizeof(double));
}

TEST_CASE("the layout of a value is that of its numbers in memory", "[unit]") {
  World world;
  world.resize<Rows>(1);
  const ValueLayout number = world.storage<Height>().layout();
  CHECK(number.number == ValueLayout::Number::real);
  CHECK(number.axes == 0);
  world.column<Stress>()[0](0, 2) = 5;
  const ValueLayout matrix = world.storage<Stress>().layout();
  REQUIRE(matrix.axes == 2);
  CHECK(matrix.axis[0].extent == 3);
  CHECK(matrix.axis[1].extent == 3);
  const std::byte* const first = world.storage<Stress>().bytes().data();
  CHECK(*reinterpret_cast<const double*>(first + 2 * matrix.axis[1].stride) == 5);
  CHECK(world.storage<Label>().layout().number == ValueLayout::Number::none);
}

TEST_CASE("a buffer that is given away keeps its values, and its column goes on with a copy", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  const double* const buffer = world.column<Height>().data();
  const std::shared_ptr<void> given = world.storage<Height>().give_away(buffer);
  REQUIRE(given);
  update(world, 1, 7);
  CHECK(world.column<Height>().data() != buffer);
  CHECK(std::vector(buffer, buffer + 3) == std::vector<double>{1, 2, 3});
  CHECK(std::vector(world.column<Height>().begin(), world.column<Height>().end()) == std::vector<double>{1, 7, 3});
  CHECK_FALSE(world.storage<Height>().give_away(buffer));
}

TEST_CASE("a buffer is given away wherever a step that is taken back has put it", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  world.mark();
  const double* const buffer = world.column<Height>().data();
  const Write<Height> h(world);  // sets the old values aside
  std::fill(h.begin(), h.end(), 9.0);
  const double* const written = world.column<Height>().data();
  world.roll_back();
  const std::shared_ptr<void> given = world.storage<Height>().give_away(written);
  REQUIRE(given);
  CHECK(written[0] == 9);
  CHECK(world.column<Height>().data() == buffer);
}

TEST_CASE("a column that is described at run time is one like all others", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  static constexpr ComponentInfo info{"row.tag", "", "1", Lifetime::state};
  ColumnStorage<double>& tag = world.add_column<double>(info, Rows::name);
  REQUIRE(tag.rows() == 3);
  std::copy_n(std::array{10.0, 20.0, 30.0}.begin(), 3, tag.values().begin());
  Resize<Rows>(world).reorder(std::vector<std::uint32_t>{2, 0, 1});
  CHECK(std::vector(tag.values().begin(), tag.values().end()) == std::vector<double>{30, 10, 20});
  CHECK(world.components().at("row.tag") == &tag);
  CHECK_THROWS_AS(world.add_column<double>(info, Rows::name), std::logic_error);
}

TEST_CASE("bytes between the members of a resource are zero, whatever was in its memory before", "[unit]") {
  for (int k = 0; k < 100; ++k) {
    auto* const before = new std::array<unsigned char, sizeof(Padded)>;
    before->fill(0xff);
    delete before;
    World world;
    world.resource<Padded>();
    const auto bytes = world.components().at("padded")->bytes();
    REQUIRE(bytes.size() == sizeof(Padded));
    for (std::size_t b = sizeof(double) + 1; b < bytes.size(); ++b) REQUIRE(bytes[b] == std::byte{0});
  }
}

TEST_CASE("a value that owns memory has no bytes to store", "[unit]") {
  World world;
  world.resize<Rows>(2);
  CHECK(world.storage<Label>().value_bytes() == 0);
  CHECK(world.storage<Label>().bytes().empty());
}

TEST_CASE("what systems change after a mark is taken back", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  world.resource<Amount>().value = 7;
  world.mark();
  SECTION("a column that is updated") { update(world, 1, 5); }
  SECTION("a column that is written anew") {
    const Write<Height> h(world);
    std::fill(h.begin(), h.end(), 9.0);
  }
  SECTION("a column that is updated twice") {
    update(world, 1, 5);
    update(world, 1, 6);
  }
  SECTION("the order of rows") {
    Resize<Rows>(world).reorder(std::vector<std::uint32_t>{2, 0, 1});
    update(world, 0, 5);
  }
  SECTION("the number of rows") {
    Resize<Rows>(world).renumber(std::vector<std::optional<std::uint32_t>>{1});
    update(world, 0, 5);
  }
  SECTION("the number of rows, where they stay") { Resize<Rows>(world).resize(5); }
  SECTION("a resource") {
    const Update<Amount> total(world);
    total->value = 8;
  }
  SECTION("nothing") {}
  world.roll_back();
  CHECK(world.rows<Rows>() == 3);
  CHECK(values(world.column<Height>()) == std::vector<double>{1, 2, 3});
  CHECK(world.resource<Amount>().value == 7);
}

TEST_CASE("a column whose rows move in every step that may be taken back has two buffers", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  std::set<const double*> buffers;
  for (int step = 0; step < 6; ++step) {
    Resize<Rows>(world).reorder(std::vector<std::uint32_t>{2, 0, 1});
    buffers.insert(world.column<Height>().data());
    world.mark();
    if (step == 3) world.roll_back();
  }
  CHECK(buffers.size() == 2);
}

TEST_CASE("rows that have changed and then moved are taken back", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  for (int step = 0; step < 3; ++step) {
    world.mark();
    update(world, 1, 6);
    Resize<Rows>(world).reorder(std::vector<std::uint32_t>{2, 0, 1});
    CHECK(values(world.column<Height>()) == std::vector<double>{3, 1, 6});
    Resize<Rows>(world).reorder(std::vector<std::uint32_t>{1, 2, 0});
    CHECK(values(world.column<Height>()) == std::vector<double>{1, 6, 3});
    world.roll_back();
    CHECK(values(world.column<Height>()) == std::vector<double>{1, 2, 3});
  }
}

TEST_CASE("columns that are scratch follow the rows that are taken back", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  world.column<Slope>();
  world.mark();
  Resize<Rows>(world).resize(1);
  world.roll_back();
  CHECK(world.column<Slope>().size() == 3);
}

TEST_CASE("a mark stands for the state then, not for that of an earlier mark", "[unit]") {
  World world = world_with_heights({1, 2, 3});
  world.mark();
  update(world, 0, 4);
  world.mark();
  update(world, 0, 5);
  world.roll_back();
  CHECK(values(world.column<Height>()) == std::vector<double>{4, 2, 3});
}

TEST_CASE("constant columns go back with the rows of their table", "[unit]") {
  World world;
  world.resize<Rows>(3);
  for (std::size_t k = 0; k < 3; ++k) {
    world.column<Height>()[k] = static_cast<double>(k);
    world.column<Colour>()[k] = 10 * static_cast<double>(k);
  }
  world.mark();
  Resize<Rows>(world).reorder(std::vector<std::uint32_t>{2, 0, 1});
  REQUIRE(world.column<Colour>()[0] == 20);
  world.roll_back();
  for (std::size_t k = 0; k < 3; ++k) CHECK(world.column<Colour>()[k] == 10 * world.column<Height>()[k]);
}
