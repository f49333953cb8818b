#include "systems/ranks/rank_map.hpp"

#include "components/particle.hpp"
#include "engine/input/problem.hpp"
#include "engine/run/communicator.hpp"
#include "engine/run/step_control.hpp"
#include "engine/schedule/schedule.hpp"
#include "support/rows.hpp"
#include "systems/ranks/site_exchange.hpp"

#include <catch2/catch.hpp>

#include <numeric>
#include <random>
#include <set>

using namespace minamo;

TEST_CASE("Morton's curve goes through the four quarters one after the other, x first", "[unit]") {
  CHECK(morton_key<2>({0, 0}) == 0);
  CHECK(morton_key<2>({1, 0}) == 1);
  CHECK(morton_key<2>({0, 1}) == 2);
  CHECK(morton_key<2>({1, 1}) == 3);
  CHECK(morton_key<2>({2, 0}) == 4);
  CHECK(morton_key<3>({0, 0, 1}) == 4);
  CHECK(morton_key<3>({3, 1, 2}) == 0b101011);
  constexpr int last = (1 << 21) - 1;
  CHECK(morton_key<3>({last, last, last}) == (std::uint64_t{1} << 63) - 1);
}

TEST_CASE("the curve is cut into pieces of as many particles, in whole blocks", "[unit]") {
  std::vector<BlockLoad> loads;
  for (std::uint64_t k = 0; k < 40; ++k) loads.push_back({3 * k, 1 + k % 5});
  for (const int ranks : {1, 2, 3, 7}) {
    const RankMap map = cut_curve(loads, ranks);
    REQUIRE(map.begin.size() == static_cast<std::size_t>(ranks));
    std::vector<std::uint64_t> particles(static_cast<std::size_t>(ranks));
    for (const BlockLoad& load : loads) particles[static_cast<std::size_t>(map.owner(load.key))] += load.particles;
    // The mean is 120 over the ranks; a block has 5 at most, of which a cut may give half to the wrong side.
    for (const std::uint64_t of_rank : particles) CHECK(std::abs(static_cast<double>(of_rank) - 120.0 / ranks) <= 5);
  }
}

TEST_CASE("no other cut of the curve leaves the fullest rank less", "[unit]") {
  std::mt19937 random(GENERATE(range(1U, 21U)));
  std::vector<BlockLoad> loads;
  for (std::uint64_t k = 0; k < 9; ++k) loads.push_back({2 * k, 1 + random() % 50});
  constexpr int ranks = 3;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (std::uint64_t second = 0; second < 18; ++second) {
    for (std::uint64_t third = second; third < 18; ++third)
      least = std::min<std::uint64_t>(least, fullest({.begin = {0, second, third}, .rank = {0, 1, 2}}, loads));
  }
  CHECK(fullest(cut_curve(loads, ranks), loads) == least);
}

TEST_CASE("the fullest rank has the most particles", "[unit]") {
  const std::vector<BlockLoad> loads{{0, 9}, {5, 4}, {5, 6}, {7, 3}};
  CHECK(fullest({.begin = {0, 5, 6}, .rank = {1, 0, 1}}, loads) == 12);
  CHECK(fullest(cut_curve(loads, 1), loads) == 22);
}

TEST_CASE("with more ranks than blocks some have none, and all blocks have a rank", "[unit]") {
  const std::vector<BlockLoad> loads{{0, 9}, {5, 9}};
  const RankMap map = cut_curve(loads, 6);
  REQUIRE(map.begin.size() == 6);
  CHECK(map.owner(0) != map.owner(5));
  for (const std::uint64_t key : {0, 5, 1000}) CHECK((map.owner(key) >= 0 && map.owner(key) < 6));
}

namespace {

/// All within so many blocks, one by one.
template <int Dim>
std::set<Index<Dim>> around(const Grid<Dim>& grid, const Index<Dim>& place, int within) {
  const CellBlocks<Dim> blocks(grid, grid.cells);
  std::set<Index<Dim>> all;
  const std::size_t cells = static_cast<std::size_t>(grid.cells[0]) * static_cast<std::size_t>(grid.cells[1]) *
                            (Dim == 3 ? static_cast<std::size_t>(grid.cells[Dim - 1]) : 1);
  for (std::size_t k = 0; k < cells; ++k) {
    Index<Dim> cell;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d) {
      cell[d] = static_cast<int>(rest % static_cast<std::size_t>(grid.cells[d]));
      rest /= static_cast<std::size_t>(grid.cells[d]);
    }
    const Index<Dim> other = blocks.place_of(cell);
    bool is_near = true;
    for (std::size_t d = 0; d < Dim; ++d) {
      const int apart = std::abs(other[d] - place[d]);
      const int count = std::max(1, grid.cells[d] / 4);
      is_near &= std::min(apart, grid.periodic[d] ? count - apart : apart) <= within;
    }
    if (is_near && other != place) all.insert(other);
  }
  return all;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the blocks around one are those near it, across periodic sides, too", "[unit]",
                       ((int Dim), Dim), 2, 3) {
  Grid<Dim> grid;
  grid.cells.fill(9);
  grid.cells[0] = 23;
  grid.periodic[0] = GENERATE(false, true);
  grid.periodic[1] = GENERATE(false, true);
  const int within = GENERATE(1, 2);
  const CellBlocks<Dim> blocks(grid, grid.cells);
  for (const int x : {0, 2, 4}) {
    Index<Dim> place{};
    place[0] = x;
    place[1] = 1;
    std::vector<Index<Dim>> found;
    blocks.for_each_around(place, within, [&](const Index<Dim>& other) { found.push_back(other); });
    const std::set<Index<Dim>> each(found.begin(), found.end());
    CHECK(each.size() == found.size());
    CHECK(each == around<Dim>(grid, place, within));
  }
}

TEST_CASE("rows go from world to world with all that outlives a step", "[unit]") {
  World from;
  World to;
  for (World* world : {&from, &to}) {
    world->column<particle::Id>();
    world->column<particle::Position<2>>();
    world->column<particle::BodyForce<2>>();  // scratch: stays
  }
  from.resize<Particles>(4);
  to.resize<Particles>(1);
  for (std::size_t p = 0; p < 4; ++p) {
    from.column<particle::Id>()[p] = static_cast<std::int64_t>(10 + p);
    from.column<particle::Position<2>>()[p] = Vec<2>(p, -1.0 * static_cast<double>(p));
  }
  to.column<particle::Id>()[0] = 7;
  to.append(Particles::name, from.pack(Particles::name, std::vector<std::uint32_t>{3, 1}));
  REQUIRE(to.rows<Particles>() == 3);
  const auto id = to.column<particle::Id>();
  CHECK(std::vector<std::int64_t>(id.begin(), id.end()) == std::vector<std::int64_t>{7, 13, 11});
  CHECK(to.column<particle::Position<2>>()[1] == Vec<2>(3, -3));
  CHECK(to.column<particle::BodyForce<2>>().size() == 3);

  SECTION("or into rows that are there") {
    const std::vector<std::uint32_t> rows{2, 0};
    const auto packed = from.pack(Particles::name, rows);
    CHECK(packed.size() == 2 * from.packed_bytes(Particles::name));
    // A row is in one piece.
    const auto row_bytes = static_cast<std::ptrdiff_t>(from.packed_bytes(Particles::name));
    CHECK(std::vector(packed.begin() + row_bytes, packed.end()) ==
          from.pack(Particles::name, std::vector<std::uint32_t>{0}));
    to.mark();
    to.unpack(Particles::name, std::vector<std::uint32_t>{0, 1}, packed);
    CHECK(std::vector<std::int64_t>(id.begin(), id.end()) == std::vector<std::int64_t>{12, 10, 11});
    CHECK(to.column<particle::Position<2>>()[0] == Vec<2>(2, -2));
    to.roll_back();
    const auto before = to.column<particle::Id>();
    CHECK(std::vector<std::int64_t>(before.begin(), before.end()) == std::vector<std::int64_t>{7, 13, 11});
  }
}

TEMPLATE_TEST_CASE_SIG("no block whose cells touch a site is leapt over", "[unit]",
                       ((int Dim, int Degree), Dim, Degree), (2, 2), (2, 3), (3, 2), (3, 3)) {
  Grid<Dim> grid;
  grid.cells.fill(9);
  grid.periodic[0] = GENERATE(false, true);
  const Splines<Dim> splines = make_splines(grid, Degree);
  const RankBlocks<Dim> blocks(grid, grid.cells);
  for (int x = 0; x < splines.axis[0].sites(); ++x) {
    for (int y = 0; y < splines.axis[1].sites(); ++y) {
      Index<Dim> site{};
      site.fill(4);
      site[0] = x;
      site[1] = y;
      std::set<Index<Dim>> all;
      for (std::size_t k = 0; k < power(Degree + 1, Dim); ++k) {
        Index<Dim> cell;
        std::size_t rest = k;
        bool is_cell = true;
        for (std::size_t d = 0; d < Dim; ++d, rest /= Degree + 1) {
          cell[d] = site[d] - static_cast<int>(rest % (Degree + 1));
          if (grid.periodic[d]) cell[d] = (cell[d] + grid.cells[d]) % grid.cells[d];
          is_cell = is_cell && cell[d] >= 0 && cell[d] < grid.cells[d];
        }
        if (is_cell) all.insert(blocks.place_of(cell));
      }
      std::set<Index<Dim>> found;
      for_each_touching_block<Dim>(splines, site, [&](const Index<Dim>& cell) { found.insert(blocks.place_of(cell)); });
      CHECK(found == all);
    }
  }
}

namespace {

/// Two ranks, of which the other one fails or not.
class WithAnother final : public Communicator {
 public:
  explicit WithAnother(std::string failure_of_other = {}) : failure_(std::move(failure_of_other)) {}
  using Communicator::exchange;
  using Communicator::sum;
  int on_this_machine() const override { return 2; }
  int rank() const override { return 1; }
  int size() const override { return 2; }
  Effort effort() const override { return {}; }
  void sum(std::span<double>) override {}
  std::int64_t sum(std::int64_t value) override { return value; }
  std::int64_t sum_below(std::int64_t) override { return 0; }
  double largest(double value) override { return failure_.empty() ? value : 2; }  // rank 0 is the lowest
  std::string broadcast(std::string text, int root) override {
    return root == 0 && !failure_.empty() ? failure_ : text;
  }
  void abort(int) override {}
  std::vector<std::vector<std::byte>> gather(std::vector<std::byte> own) override { return {own, own}; }
  bool write(const std::string&, std::span<const Piece>) override { return true; }
  void exchange(const std::vector<Message>&, std::vector<Message>&) override {}

 private:
  std::vector<Message> exchange_between_strangers(const std::vector<Message>&) override { return {}; }
  std::string failure_;
};

}  // namespace

TEST_CASE("what fails on one rank fails on all, as the same kind", "[unit]") {
  WithAnother sound;
  CHECK_NOTHROW(agree_on_failure(sound, nullptr));
  CHECK_THROWS_AS(do_on_all(&sound, [] { throw StepRejected("too long"); }), StepRejected);
  CHECK_THROWS_WITH(do_on_all(&sound, [] { throw std::runtime_error("disk full"); }), "disk full");
  WithAnother rejecting("rtoo long");
  CHECK_THROWS_AS(do_on_all(&rejecting, [] {}), StepRejected);
  WithAnother failing("fdisk full");
  CHECK_THROWS_AS(do_on_all(&failing, [] {}), FailedElsewhere);
  CHECK_NOTHROW(do_on_all(nullptr, [] {}));
}

TEST_CASE("a problem that several ranks find is told once", "[unit]") {
  WithAnother other;
  CHECK_NOTHROW(agree_on_problems(&other, {}));
  const std::vector<Problem> problems{{"a.json", "/x", "not finite", "a number", "nan", {}},
                                      {"a.json", "/y", "not finite", "a number", "nan", {}},
                                      {"a.json", "/x", "not finite", "a number", "inf", {}}};
  try {
    agree_on_problems(&other, problems);
    FAIL("nothing is thrown");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 2);
    CHECK(error.problems()[0].text() == problems[0].text());
    CHECK(error.problems()[1].text() == problems[1].text());
  }
  CHECK_THROWS_AS(agree_on_problems(nullptr, problems), InputError);
}
