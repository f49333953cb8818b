#pragma once
/// \file
/// Sponge layers: regions that draw the velocity of the liquid towards a given one, so that waves end there.

#include "components/energy_given.hpp"
#include "components/grid.hpp"
#include "components/instant.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"

#include <optional>

namespace minamo {

struct Sponge {
  std::optional<Expression> where;  ///< in x, y, z, t; none: everywhere
  Expression rate;                  ///< in x, y, z, t; less than zero counts as zero [1/s]
  std::vector<double> toward;       ///< [m/s]
};

struct Sponges {
  std::vector<Sponge> sponges;
  static constexpr ComponentInfo info{"sponges", "", "1/s, m/s", Lifetime::constant};
};

/// Share exp(-r dt) of what sponges leave of a particle's velocity relative to theirs. [1]
struct SpongeShare : Column<Particles, double> {
  static constexpr ComponentInfo info{"sponge.share", "", "1", Lifetime::scratch};
};

/// (E102)  v_p <- v_s + (v_p - v_s) exp(-r dt), at y_p. Where that brings energy in a step, it is given; what it takes
/// is lost as to friction.
/// \throws std::runtime_error if a rate or `where` is not a number
template <int Dim>
struct SoakVelocity {
  static constexpr Doc doc = "(E102) v_p in sponges";
  void operator()(Read<Clock> clock, Read<Sponges> sponges, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Mass> m_p, Optional<Read<Ranks>> ranks, Write<SpongeShare> kept,
                  Update<particle::Velocity<Dim>> v_p, Update<EnergyGiven> given) const;
};

/// (E102)  grad v_p <- grad v_p exp(-r dt).
template <int Dim>
struct SoakGradient {
  static constexpr Doc doc = "(E102) grad v_p in sponges";
  void operator()(Read<SpongeShare> kept, Update<particle::VelocityGradient<Dim>> grad_v_p) const;
};

}  // namespace minamo
