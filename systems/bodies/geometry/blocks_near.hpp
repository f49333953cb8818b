#pragma once
/// \file
/// Which blocks of cells have a body near: there a rank has to know more of what others have than elsewhere.

#include "components/grid.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/ghost_cells.hpp"

namespace minamo {

/// How far from a face the liquid may lie from which what a body cuts at it is continued (E135), or its mass levelled
/// (E123): a few passes of two sites each, in most scenes all of them.
inline constexpr int sites_of_continuation = 18;

/// Blocks from whose cells a site near a body is within what ranks know everywhere.
template <int Dim>
struct FindBlocksNearBodies {
  static constexpr Doc doc = "blocks of cells that have a body near";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<ReachOnRanks> reach,
                  Uses<BodyPlacement<Dim>> placement, Write<BlocksNearBodies> blocks) const;
};

}  // namespace minamo
