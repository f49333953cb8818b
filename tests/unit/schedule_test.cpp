#include "engine/schedule/schedule.hpp"

#include "support/rows.hpp"

#include <catch2/catch.hpp>

#include <initializer_list>
#include <vector>

using namespace minamo;
using namespace minamo::rows;

namespace {

struct Sum {
  double value = 0;
  static constexpr ComponentInfo info{"total", "T", "m", Lifetime::scratch};
};

/// A declaration without a kernel.
System declared(std::string name, std::vector<Access> access) {
  return {std::move(name), std::move(access), [](World&) {}, [](World&) {}};
}

const Access reads_h = Read<Height>::access();
const Access writes_h = Write<Height>::access();
const Access updates_h = Update<Height>::access();
const Access reads_s = Read<Slope>::access();
const Access writes_s = Write<Slope>::access();
const Access updates_s = Update<Slope>::access();
const Access writes_d = Write<Depth>::access();
const Access reads_d = Read<Depth>::access();
const Access reads_T = Read<Sum>::access();
const Access writes_T = Write<Sum>::access();
const Access resizes = Resize<Rows>::access();
const Access as_bytes = RowBytes<Rows>::access();
const Access resizes_other = Resize<OtherRows>::access();

using Lines = std::vector<std::string>;

Lines unwritten(std::initializer_list<System> systems) { return unwritten_reads(std::vector<System>(systems)); }
std::vector<Edge> edges(std::initializer_list<System> systems) { return derive_edges(std::vector<System>(systems)); }

}  // namespace

TEST_CASE("two accesses to one component conflict unless both read", "[unit]") {
  const auto [x, y, expected] = GENERATE(table<Access, Access, bool>({
      {reads_h, reads_h, false},
      {reads_h, writes_h, true},
      {reads_h, updates_h, true},
      {writes_h, writes_h, true},
      {updates_h, updates_h, true},
      {writes_T, reads_T, true},
      {reads_T, reads_T, false},
  }));
  CHECK(conflict(x, y) == expected);
  CHECK(conflict(y, x) == expected);
}

TEST_CASE("accesses to different components do not conflict", "[unit]") {
  CHECK_FALSE(conflict(writes_h, writes_s));
  CHECK_FALSE(conflict(writes_h, writes_T));
}

TEST_CASE("a resize, and rows as bytes, conflict with every access to their table and with no other", "[unit]") {
  const Access of_table = GENERATE(resizes, as_bytes);
  const auto [access, expected] = GENERATE(table<Access, bool>({
      {reads_h, true},
      {writes_s, true},
      {resizes, true},
      {as_bytes, true},
      {writes_d, false},
      {resizes_other, false},
      {writes_T, false},
  }));
  CHECK(conflict(of_table, access) == expected);
  CHECK(conflict(access, of_table) == expected);
}

TEST_CASE("readers of one component do not wait for each other", "[unit]") {
  CHECK(edges({declared("a", {writes_h}), declared("b", {reads_h}), declared("c", {reads_h})}) ==
        std::vector<Edge>{{0, 1}, {0, 2}});
}

TEST_CASE("a writer waits for all earlier readers", "[unit]") {
  CHECK(edges({declared("a", {reads_h}), declared("b", {reads_h}), declared("c", {writes_h})}) ==
        std::vector<Edge>{{1, 2}, {0, 2}});
}

TEST_CASE("an order that follows from others has no edge", "[unit]") {
  CHECK(edges({declared("a", {writes_h}), declared("b", {updates_h}), declared("c", {reads_h})}) ==
        std::vector<Edge>{{0, 1}, {1, 2}});
}

TEST_CASE("an order that follows from a longer path has no edge", "[unit]") {
  CHECK(edges({declared("a", {writes_h, writes_T}), declared("b", {reads_h, writes_s}),
               declared("c", {reads_s, writes_d}), declared("d", {reads_T, reads_d})}) ==
        std::vector<Edge>{{0, 1}, {1, 2}, {2, 3}});
}

TEST_CASE("scratch written before it is read is accepted", "[unit]") {
  CHECK(unwritten({declared("a", {writes_s, writes_T}), declared("b", {reads_s, reads_T})}).empty());
}

TEST_CASE("state may be read before it is written", "[unit]") { CHECK(unwritten({declared("a", {reads_h})}).empty()); }

TEST_CASE("scratch read before it is written is refused", "[unit][error]") {
  CHECK(unwritten({declared("a", {reads_s}), declared("b", {writes_s})}) ==
        Lines{"system \"a\" reads row.slope, which no earlier system of the step writes"});
}

TEST_CASE("scratch updated before it is written is refused", "[unit][error]") {
  CHECK(unwritten({declared("a", {updates_s})}) ==
        Lines{"system \"a\" updates row.slope, which no earlier system of the step writes"});
}

TEST_CASE("an update does not count as a write", "[unit][error]") {
  CHECK(unwritten({declared("a", {updates_s}), declared("b", {reads_s})}).size() == 2);
}

TEST_CASE("an update after a write leaves scratch readable", "[unit]") {
  CHECK(unwritten({declared("a", {writes_s}), declared("b", {updates_s}), declared("c", {reads_s})}).empty());
}

TEST_CASE("a system's own write does not make its own read legal", "[unit][error]") {
  CHECK(unwritten({declared("a", {writes_s, reads_s})}).size() == 1);
}

TEST_CASE("a resize makes the scratch of its table stale", "[unit][error]") {
  CHECK(unwritten({declared("a", {writes_s}), declared("grow", {resizes}), declared("b", {reads_s})}) ==
        Lines{"system \"b\" reads row.slope, which no earlier system of the step writes after \"grow\" resizes row"});
}

TEST_CASE("rows as bytes leave the scratch of their table readable", "[unit]") {
  CHECK(unwritten({declared("a", {writes_s}), declared("bytes", {as_bytes}), declared("b", {reads_s})}).empty());
}

TEST_CASE("a resize leaves the scratch of other tables and of resources readable", "[unit]") {
  CHECK(unwritten({declared("a", {writes_d, writes_T}), declared("grow", {resizes}), declared("b", {reads_d, reads_T})})
            .empty());
}

TEST_CASE("a system that resizes a table and writes its scratch resizes first", "[unit]") {
  CHECK(unwritten({declared("a", {writes_s, resizes}), declared("b", {reads_s})}).empty());
}

TEST_CASE("a system that resizes a table cannot read its scratch", "[unit][error]") {
  CHECK(unwritten({declared("a", {writes_s}), declared("grow", {reads_s, resizes})}).size() == 1);
}

TEST_CASE("scratch written again after a resize is readable", "[unit]") {
  CHECK(unwritten({declared("a", {writes_s}), declared("grow", {resizes}), declared("b", {writes_s}),
                   declared("c", {reads_s})})
            .empty());
}

TEST_CASE("a component that a system names more than once is reported once", "[unit][error]") {
  CHECK(repeated_accesses(std::vector{declared("a", {reads_h, writes_s, writes_h, updates_h})}) ==
        Lines{"system \"a\" names row.height twice"});
}

TEST_CASE("a table that a system resizes twice is reported", "[unit][error]") {
  CHECK(repeated_accesses(std::vector{declared("a", {resizes, resizes_other, resizes})}) ==
        Lines{"system \"a\" names row twice"});
}

TEST_CASE("different components of different systems are not repetitions", "[unit]") {
  CHECK(repeated_accesses(std::vector{declared("a", {resizes, reads_h, reads_s}), declared("b", {reads_h})}).empty());
}

TEST_CASE("a schedule reports all that is wrong with its list at once", "[unit][error]") {
  World world;
  CHECK_THROWS_AS(Schedule({declared("a", {reads_s})}, world), ScheduleError);
  CHECK_THROWS_WITH(
      Schedule({declared("a", {reads_s}), declared("b", {reads_h, reads_h}), declared("c", {reads_T})}, world),
      "system \"b\" names row.height twice\n"
      "system \"a\" reads row.slope, which no earlier system of the step writes\n"
      "system \"c\" reads total, which no earlier system of the step writes");
}
