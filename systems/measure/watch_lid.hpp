#pragma once
/// \file
/// Whether liquid has come up to a lid that the scene may not mean.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/run/warnings.hpp"
#include "engine/schedule/system.hpp"

#include <vector>

namespace minamo {

/// Sides of the box above the liquid that hold what touches them, and that the liquid was below when it started.
template <int Dim>
struct Lids {
  struct Lid {
    std::size_t axis = 0;
    bool is_high = true;
    double at = 0;  ///< coordinate along the axis [m]
  };
  std::vector<Lid> lids;
  static constexpr ComponentInfo info{"lids", "", "", Lifetime::constant};
};

/// A side is above the liquid where its outward normal n has n . b < -|b| / 2, b a constant body force. It holds what
/// touches it unless it is periodic, separating, or has an opening. Liquid within a cell of it at the start means it.
/// \pre particles, walls and openings are seeded
template <int Dim>
Lids<Dim> lids_of(const Vec<Dim>& body_force, World& world);

/// Warns once when a particle is within a quarter of a cell of a lid, as particles of liquid that touches it are.
template <int Dim>
struct WatchLid {
  static constexpr Doc doc = "warn when liquid touches the lid of a tank for the first time";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Lids<Dim>> lids,
                  Optional<Read<OccupiedCells<Dim>>> dual_cells, Optional<Read<GridCells<Dim>>> cells,
                  Read<particle::Position<Dim>> x_p, Optional<Read<Ranks>> ranks, Update<Warnings> warnings) const;
};

}  // namespace minamo
