#include "support/grids.hpp"
#include "support/kernels.hpp"

#include "components/sites.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Random sites by their places in the order of the grid, some of them twice.
template <int Dim>
std::map<std::size_t, Index<Dim>> add_random(SiteRows<Dim>& rows, const Grid<Dim>& grid, int count,
                                             std::uint64_t seed) {
  Random random(seed);
  std::map<std::size_t, Index<Dim>> added;
  for (int k = 0; k < count; ++k) {
    Index<Dim> site;
    for (int d = 0; d < Dim; ++d) site[static_cast<std::size_t>(d)] = static_cast<int>(random(0, grid.nodes(d)));
    rows.add(site);
    added[grid.row(site)] = site;
  }
  return added;
}

/// Sites of the grid whose row is another than a count along the map gives.
template <int Dim>
std::size_t wrong_rows(const SiteRows<Dim>& rows, const Grid<Dim>& grid,
                       const std::map<std::size_t, Index<Dim>>& expected) {
  std::size_t wrong = 0;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < grid.node_count(); ++i) {
    const auto row = rows.find(grid.index(i));
    wrong += row != (expected.count(i) == 1 ? std::optional(next++) : std::nullopt);
  }
  return wrong;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("rows of sites are those of a map in the order of the grid", "[unit]", ((int Dim), Dim), 2, 3) {
  const int count = GENERATE(0, 1, 40, 900, 20000);
  CAPTURE(count);
  const Grid<Dim> grid = long_grid<Dim>();
  SiteRows<Dim> rows;
  rows.start(grid);
  const auto expected = add_random<Dim>(rows, grid, count, 61);
  CHECK(rows.number_rows() == expected.size());
  CHECK(wrong_rows<Dim>(rows, grid, expected) == 0);
}

TEMPLATE_TEST_CASE_SIG("rows of sites know nothing of those before", "[unit]", ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = long_grid<Dim>();
  SiteRows<Dim> rows;
  rows.start(grid);
  add_random<Dim>(rows, grid, 500, 62);
  rows.number_rows();
  rows.start(grid);
  const auto expected = add_random<Dim>(rows, grid, 300, 63);
  CHECK(rows.number_rows() == expected.size());
  CHECK(wrong_rows<Dim>(rows, grid, expected) == 0);
}

TEST_CASE("rows of sites follow another grid", "[unit]") {
  SiteRows<2> rows;
  rows.start(long_grid<2>());
  add_random<2>(rows, long_grid<2>(), 500, 64);
  const Grid<2> grid = small_grid<2>();
  rows.start(grid);
  const auto expected = add_random<2>(rows, grid, 30, 65);
  CHECK(rows.number_rows() == expected.size());
  CHECK(wrong_rows<2>(rows, grid, expected) == 0);
}

TEMPLATE_TEST_CASE_SIG("every site with a row comes up once", "[unit]", ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = long_grid<Dim>();
  SiteRows<Dim> rows;
  rows.start(grid);
  const auto expected = add_random<Dim>(rows, grid, 700, 66);
  rows.number_rows();
  std::vector<int> times(expected.size(), 0);
  rows.for_each([&](const Index<Dim>& site, std::uint32_t row) { times[row] += rows.find(site) == row; });
  CHECK(times == std::vector<int>(expected.size(), 1));
}

TEST_CASE("a block has its number until the numbers start anew", "[unit]") {
  BlockNumbers blocks;
  blocks.start(10);
  CHECK(blocks.number(7) == 0);
  CHECK(blocks.number(2) == 1);
  CHECK(blocks.number(7) == 0);
  blocks.sort();
  CHECK(std::vector<std::uint32_t>(blocks.used().begin(), blocks.used().end()) == std::vector<std::uint32_t>{2, 7});
  CHECK(blocks.find(7) == 0U);
  CHECK_FALSE(blocks.find(3));
  CHECK_FALSE(blocks.find(10));
  blocks.start(12);
  CHECK_FALSE(blocks.find(7));
  CHECK(blocks.size() == 0);
}
