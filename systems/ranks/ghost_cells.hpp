#pragma once
/// \file
/// The occupied cells of other ranks around those of this one. They have no particles here, but their sites have rows,
/// so that what is known of a site and of its neighbours is the same on every rank that needs it.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/staggered.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/rank_map.hpp"

namespace minamo {

template <int Dim>
struct GhostCells {
  struct Cell {
    Index<Dim> at;
    int rank;                  ///< that has its particles
    std::uint64_t hidden = 0;  ///< what is hidden from them, as HiddenSites::of_cell
  };
  std::vector<Cell> cells;             ///< by rank, in its order
  std::vector<std::uint64_t> covered;  ///< keys of the blocks all of whose occupied cells are known here, rising
  static constexpr ComponentInfo info{"ranks.ghost_cells", "", "1", Lifetime::scratch};

  bool covers(std::uint64_t key) const { return std::binary_search(covered.begin(), covered.end(), key); }
};

/// How many sites further than the cells that touch a face what follows from it reaches.
struct ReachOnRanks {
  int sites = 2;
  static constexpr ComponentInfo info{"ranks.reach", "", "1", Lifetime::constant};
};

/// A scene has something that reaches so far.
inline void reach_on_ranks(World& world, int sites) {
  if (all_ranks() == nullptr) return;
  auto& reach = world.resource<ReachOnRanks>();
  reach.sites = std::max(reach.sites, sites);
}

/// The blocks from which it reaches further, for a body is near.
struct BlocksNearBodies {
  int sites = 0;
  std::vector<std::uint8_t> has_near;  ///< by CellBlocks::block_of()
  static constexpr ComponentInfo info{"bodies.blocks_near", "", "1", Lifetime::scratch};
};

/// Blocks around an occupied one whose cells its rank has to know: a face is touched by cells up to K sites away.
constexpr int layers_of_ghosts(int degree, int sites) { return (degree + sites + 3) / 4; }

template <int Dim>
struct FindGhostCells {
  static constexpr Doc doc = "occupied cells of other ranks around those of this one";
  void operator()(Read<Ranks> ranks, Read<RankMap> map, Read<ReachOnRanks> reach, Read<Grid<Dim>> grid,
                  Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells, Optional<Read<HiddenSites>> hidden,
                  Optional<Read<BlocksNearBodies>> near, Write<GhostCells<Dim>> ghosts) const;
};

}  // namespace minamo
