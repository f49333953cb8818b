#pragma once
/// \file
/// Particles that come in through openings and leave through them.
///
/// Outside an opening lies a lattice of spacing a, in columns across the side. It moves with the velocity in the
/// opening: every column across the side with that at its place, all of them together along the side. In front of a
/// step come in those particles that the step will carry over the side; they start where the lattice has them,
/// outside. So what comes in joins what came in before without gap or overlap, however long the steps are, and what a
/// step takes of the liquid it finds complete. Openings with the same velocity have the same lattice: a particle that
/// does not come in through one side comes in through the next.

#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/ranks/rank_map.hpp"

namespace minamo {

/// (E101)  The particles that this step carries into the box, V_p = a^d, m_p = rho V_p, v_p = w(x_p, t^n). All ranks
/// know of all of them; the one that has the block of a particle makes it.
template <int Dim>
struct LetIn {
  static constexpr Doc doc = "(E101) particles that come in through openings";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                  Read<BodyForce> b, Read<OpeningSet<Dim>> set, Optional<Read<Ranks>> ranks,
                  Optional<Read<RankMap>> map, Resize<Particles> particles, Update<particle::Id> id,
                  Update<particle::Mass> m_p, Update<particle::Volume> V_p, Update<particle::Position<Dim>> x_p,
                  Update<particle::Velocity<Dim>> v_p, Write<opening::Arrivals<Dim>> arrivals,
                  Update<opening::Front> front, Read<opening::Speed> speed, Update<opening::Drift<Dim>> drift,
                  Update<opening::NextId> next_id, Update<opening::MassIn> mass_in,
                  Update<opening::EnergyIn> energy_in) const;
};

/// The velocity gradients of those particles, for transfer schemes that carry one.
template <int Dim>
struct GiveGradient {
  static constexpr Doc doc = "grad v_p of particles that come in";
  void operator()(Read<opening::Arrivals<Dim>> arrivals, Update<particle::VelocityGradient<Dim>> grad_v_p) const;
};

/// (E103)  Where the pressure drives them, the columns move by what the balances gave.
template <int Dim>
struct MoveColumns {
  static constexpr Doc doc = "(E103) columns of particles outside that the pressure drives";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                  Read<OpeningSet<Dim>> set, Read<opening::Velocities<Dim>> velocities, Update<opening::Front> front,
                  Update<opening::Speed> speed) const;
};

/// Particles beyond an opening are gone.
template <int Dim>
struct LetOut {
  static constexpr Doc doc = "particles that have left through openings";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodyForce> b, Read<OpeningSet<Dim>> set,
                  Optional<Read<Ranks>> ranks, Resize<Particles> particles, Read<particle::Mass> m_p,
                  Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p, Update<opening::MassIn> mass_in,
                  Update<opening::EnergyIn> energy_in) const;
};

}  // namespace minamo
