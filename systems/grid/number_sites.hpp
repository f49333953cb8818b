#pragma once
/// \file
/// Which sites of the staggered grid have a row, and what they know of the grid.

#include "components/cells.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/number_nodes.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/ghost_cells.hpp"

namespace minamo {

/// Sites that share a cell know each other. \param rows  of the sites of a cell
template <int Dim, int K>
void join_sites(const std::uint32_t* rows, std::span<typename staggered::Neighbour<Dim>::value_type> neighbour) {
  for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (offset[d] == K) continue;
      const std::uint32_t above = rows[k + power(K + 1, static_cast<int>(d))];
      neighbour[rows[k]][2 * d + 1] = static_cast<std::int32_t>(above);
      neighbour[above][2 * d] = static_cast<std::int32_t>(rows[k]);
    }
  });
}

/// Gives the sites of occupied cells rows, in the order of their sites. What outlives a step moves along; sites that
/// had no row start from zero.
template <int Dim>
struct NumberSites {
  static constexpr Doc doc = "number the staggered sites of occupied cells";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls, Read<GridCells<Dim>> cells,
                  Optional<Read<GhostCells<Dim>>> ghosts, Resize<Staggered> table, Write<CellSites> sites,
                  Update<StaggeredIndex<Dim>> rows, Update<staggered::Site<Dim>> site,
                  Write<staggered::Neighbour<Dim>> neighbour, Write<face::Held> held,
                  Write<multiplier::Capacity> capacity, Update<NumberingBuffer> buffer) const;
};

}  // namespace minamo
