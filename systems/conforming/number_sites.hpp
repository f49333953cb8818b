#pragma once
/// \file
/// Which sites of the staggered grid have a row, and what they know of the grid.

#include "components/cells.hpp"
#include "components/staggered.hpp"
#include "engine/system.hpp"
#include "systems/conforming/splines.hpp"
#include "systems/grid/number_nodes.hpp"
#include "systems/ranks/ghost_cells.hpp"

namespace minamo {

/// Gives the sites of occupied cells rows, in the order of their sites. What outlives a step moves along; sites that
/// had no row start from zero.
template <int Dim>
struct NumberSites {
  static constexpr std::string_view doc = "number the staggered sites of occupied cells";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls, Read<GridCells<Dim>> cells,
                  Optional<Read<GhostCells<Dim>>> ghosts, Resize<Staggered> table, Write<CellSites> sites,
                  Update<StaggeredIndex<Dim>> rows, Update<staggered::Site<Dim>> site,
                  Write<staggered::Neighbour<Dim>> neighbour, Write<face::Held> held,
                  Write<multiplier::Capacity> capacity, Update<NumberingBuffer> buffer) const;
};

}  // namespace minamo
