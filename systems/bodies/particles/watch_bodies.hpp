#pragma once
/// \file
/// Warns of liquid in the place of bodies, while the run goes on.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/run/warnings.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/cut.hpp"

namespace minamo {

/// (E127)  Warns where particles lie in bodies, deeper than a hundredth of a cell: (E89) finds no way out for them.
template <int Dim>
struct WatchBodies {
  static constexpr Doc doc = "(E127) warnings of particles in bodies";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                  Read<body::Position<Dim>> c_b, Read<body::Rotation<Dim>> R_b, Read<particle::Position<Dim>> x_p,
                  Optional<Read<Ranks>> ranks, Update<Warnings> warnings) const;
};

}  // namespace minamo
