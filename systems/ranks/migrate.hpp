#pragma once
/// \file
/// Particles move to the rank that owns the block they are in.

#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/rank_map.hpp"

namespace minamo {

/// Sends particles, with all that outlives a step, to the rank that owns the block of y_p. Where a rank has a fifth
/// more than the mean, the curve is cut anew before if that helps.
template <int Dim>
struct MigrateParticles {
  static constexpr Doc doc = "particles to the rank that owns their block";
  void operator()(Read<Ranks> ranks, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                  Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles, Update<RankMap> map) const;
};

/// The same by x_p, before the first step.
void send_particles_home(int dimension, World& world);

}  // namespace minamo
