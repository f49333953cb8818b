#include "support/grids.hpp"
#include "support/kernels.hpp"

#include "systems/grid/node_stencil.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace minamo;
using namespace minamo::kernels;

namespace {

template <int Dim>
struct Table {
  Grid<Dim> grid = long_grid<Dim>();
  SiteRows<Dim> rows;
  std::vector<Index<Dim>> sites;

  /// Nine of ten nodes, by chance.
  explicit Table(std::uint64_t seed) {
    Random random(seed);
    rows.start(grid);
    for (std::size_t i = 0; i < grid.node_count(); ++i) {
      if (random(0, 1) > 0.1) rows.add(grid.index(i));
    }
    sites.resize(rows.number_rows());
    rows.for_each([&](const Index<Dim>& site, std::uint32_t row) { sites[row] = site; });
  }

  /// Calls body(site) for the places of a stencil inside the grid, by a plain loop.
  template <class Body>
  void for_each_place(const Index<Dim>& centre, const Body& body) const {
    for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
      Index<Dim> site = centre;
      bool inside = true;
      for (std::size_t d = 0, rest = k; d < Dim; ++d, rest /= 5) {
        const int axis = static_cast<int>(d);
        site[d] = grid.wrapped(axis, site[d] + static_cast<int>(rest % 5) - 2);
        inside = inside && site[d] >= 0 && site[d] < grid.nodes(axis);
      }
      if (inside) body(k, site);
    }
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("a stencil visits the neighbours of a plain loop", "[unit]", ((int Dim), Dim), 2, 3) {
  const Table<Dim> table(71);
  const Stencil<Dim> stencil(table.grid, table.rows, table.sites);
  std::size_t wrong = 0;
  for (std::uint32_t i = 0; i < table.sites.size(); ++i) {
    std::map<std::size_t, std::uint32_t> expected;
    table.for_each_place(table.sites[i], [&](std::size_t k, const Index<Dim>& site) {
      if (const auto row = table.rows.find(site)) expected[k] = *row;
    });
    std::map<std::size_t, std::uint32_t> visited;
    stencil.for_each_neighbour(i, [&](std::size_t k, std::uint32_t j) { visited[k] = j; });
    wrong += visited != expected;
  }
  CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE_SIG("all of a stencil is what a plain loop finds", "[unit]", ((int Dim), Dim), 2, 3) {
  const Table<Dim> table(72);
  const Stencil<Dim> stencil(table.grid, table.rows, table.sites);
  const auto condition = [](std::uint32_t row) { return row % 50 != 0; };
  std::array<std::size_t, 2> found{};
  std::size_t wrong = 0;
  for (std::uint32_t i = 0; i < table.sites.size(); ++i) {
    bool expected = true;
    table.for_each_place(table.sites[i], [&](std::size_t, const Index<Dim>& site) {
      const auto row = table.rows.find(site);
      expected = expected && row && condition(*row);
    });
    ++found[expected];
    wrong += stencil.all_of(i, condition) != expected;
  }
  CHECK(wrong == 0);
  CHECK(found[0] > 0);
  if (Dim == 2) CHECK(found[1] > 0);  // of 125 neighbours in 3-D one is always missing
}
