#include "support/kernels.hpp"

#include "systems/solve/stencil_tiles.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Random sites of a grid with or without periodic axes: runs of nodes, gaps, lines without any.
template <int Dim>
struct Sites {
  Grid<Dim> grid;
  std::vector<Index<Dim>> site;
  std::vector<std::uint32_t> node;  ///< every second site has a row
  std::map<std::size_t, std::int32_t> row_of_place;

  Sites(bool periodic, double fill) {
    constexpr std::array<int, 3> cells{21, 9, 6};
    for (std::size_t d = 0; d < Dim; ++d) {
      grid.cells[d] = cells[d];
      grid.periodic[d] = periodic;
    }
    Random random(5);
    for (std::size_t i = 0; i < grid.node_count(); ++i) {
      const Index<Dim> at = grid.index(i);
      if (at[1] == 4 || random(0, 1) > fill) continue;
      if (site.size() % 2 == 1) {
        row_of_place[i] = static_cast<std::int32_t>(node.size());
        node.push_back(static_cast<std::uint32_t>(site.size()));
      }
      site.push_back(at);
    }
  }
  /// The row at a place of the stencil of a row, looked up one by one; -1 if there is none.
  std::int32_t neighbour(std::size_t row, std::size_t place) const {
    Index<Dim> at = site[node[row]];
    for (int d = 0; d < Dim; ++d, place /= 5) {
      auto& coordinate = at[static_cast<std::size_t>(d)];
      coordinate = grid.wrapped(d, coordinate + static_cast<int>(place % 5) - 2);
      if (coordinate < 0 || coordinate >= grid.nodes(d)) return -1;
    }
    const auto found = row_of_place.find(grid.row(at));
    return found == row_of_place.end() ? -1 : found->second;
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("rows in tiles have the neighbours that the grid gives them", "[unit]", ((int Dim), Dim), 2, 3) {
  const bool periodic = GENERATE(false, true);
  const double fill = GENERATE(0.05, 0.4, 1.0);
  CAPTURE(periodic, fill);
  const Sites<Dim> sites(periodic, fill);
  StencilTiles<Dim> tiles;
  tiles.build(sites.grid, sites.site, sites.node);
  REQUIRE(tiles.rows() == sites.node.size());
  std::size_t wrong = 0;
  for (std::size_t r = 0; r < tiles.rows(); ++r) {
    std::array<std::int32_t, stencil_size<Dim>> found;
    found.fill(-1);
    tiles.for_each_neighbour(r, [&](std::size_t k, std::size_t r_j) { found[k] = static_cast<std::int32_t>(r_j); });
    for (std::size_t k = 0; k < found.size(); ++k) wrong += found[k] != sites.neighbour(r, k);
  }
  CHECK(wrong == 0);
}

TEST_CASE("every row stands in one i of one tile, its neighbours in the same i", "[unit]") {
  const Sites<2> sites(true, 0.6);
  StencilTiles<2> tiles;
  tiles.build(sites.grid, sites.site, sites.node);
  std::vector<int> times(tiles.rows(), 0);
  for (const auto& tile : tiles.tiles()) {
    for (std::size_t i = 0; i < StencilTiles<2>::width; ++i) {
      if (tile.row[i] < 0) continue;
      const auto r = static_cast<std::size_t>(tile.row[i]);
      ++times[r];
      CHECK(tiles.lane(r) == tile.lane + i);
      for (std::size_t k = 0; k < stencil_size<2>; ++k) {
        CHECK(tiles.row(tile.at(k) + i) == sites.neighbour(r, k));
      }
    }
  }
  CHECK(times == std::vector<int>(tiles.rows(), 1));
}

TEST_CASE("tiles may be built again for other rows", "[unit]") {
  StencilTiles<2> tiles;
  const Sites<2> many(false, 1.0);
  const Sites<2> few(false, 0.1);
  tiles.build(many.grid, many.site, many.node);
  const std::size_t lanes = tiles.lanes();
  tiles.build(few.grid, few.site, few.node);
  CHECK(tiles.rows() == few.node.size());
  tiles.build(few.grid, {}, {});
  CHECK(tiles.rows() == 0);
  CHECK(tiles.tiles().empty());
  tiles.build(many.grid, many.site, many.node);
  CHECK(tiles.lanes() == lanes);
}
