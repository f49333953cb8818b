#pragma once
/// \file
/// (E136) Sites of the staggered grid that thin walls hide from particles, where both sides of a wall are wet.

#include "components/cells.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/ranks/ghost_cells.hpp"

namespace minamo {

/// (E136) Cells with particles on several sides of a wall become one cell per side.
template <int Dim>
struct SplitCells {
  static constexpr Doc doc = "(E136) one cell for the particles of each side of a thin wall";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Uses<BodyPlacement<Dim>> placement,
                  Read<DrySides<Dim>> dry, Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles,
                  Update<GridCells<Dim>> cells, Resize<Cells> rows, Write<HiddenSites> hidden) const;
};

/// (E136) Rows that stand for hidden sites.
template <int Dim>
struct NumberHiddenSites {
  static constexpr Doc doc = "(E136) rows for sites that thin walls hide from the particles of a cell";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<DrySides<Dim>> dry, Read<GridCells<Dim>> cells,
                  Optional<Read<GhostCells<Dim>>> ghosts, Read<StaggeredIndex<Dim>> rows, Resize<Staggered> table,
                  Update<CellSites> sites, Update<staggered::Site<Dim>> site,
                  Write<staggered::Neighbour<Dim>> neighbour, Write<face::Held> held,
                  Write<multiplier::Capacity> capacity, Update<HiddenSites> hidden) const;
};

}  // namespace minamo
