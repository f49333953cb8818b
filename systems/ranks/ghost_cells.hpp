#pragma once
/// \file
/// The occupied cells of other ranks around those of this one. They have no particles here, but their sites have rows,
/// so that what is known of a site and of its neighbours is the same on every rank that needs it.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/rank_map.hpp"

namespace minamo {

template <int Dim>
struct GhostCells {
  struct Cell {
    Index<Dim> at;
    int rank;  ///< that has its particles
  };
  std::vector<Cell> cells;             ///< by rank, in its order
  std::vector<std::uint64_t> covered;  ///< keys of the blocks all of whose occupied cells are known here, rising
  static constexpr ComponentInfo info{"ranks.ghost_cells", "", "1", Lifetime::scratch};

  bool covers(std::uint64_t key) const { return std::binary_search(covered.begin(), covered.end(), key); }
};

/// Blocks around an occupied one whose cells its rank has to know: a face is touched by cells up to K sites away, and
/// what depends on it reaches two sites further.
constexpr int layers_of_ghosts(int degree) { return (degree + 2 + 3) / 4; }

template <int Dim>
struct FindGhostCells {
  static constexpr std::string_view doc = "occupied cells of other ranks around those of this one";
  void operator()(Read<Ranks> ranks, Read<RankMap> map, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                  Read<GridCells<Dim>> cells, Write<GhostCells<Dim>> ghosts) const;
};

}  // namespace minamo
