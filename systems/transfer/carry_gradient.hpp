#pragma once
/// \file
/// The velocity gradient that a particle carries, from one configuration to the next.
///
/// A particle has its velocity gradient from the nodes, over the places y where the particles were then. When they have
/// moved on by tau v, the same velocities have another gradient over the new places:
/// (E62)  grad v (I + f tau grad v)^-1, tau = w_c dt/2 from the middle of a step to its end, and from there to the
/// middle
///        of the next; w_c (E61), f = min(1, max(0, 2 - 20 |tau grad v|)).
/// In a full and even support nobody sees the difference, since what neighbours bring weighs itself out. At surfaces
/// and walls the gradient is what extends the velocities to the nodes outside; without (E62) a step extends those of
/// the configuration before, an error of order h that (E53) leaves alone. w: what converges in free flight has a
/// gradient that grows without bound. Ours; exact for a velocity that is linear in space.

#include "components/cells.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// f of (E62), how much of a strain |tau grad v| the grid resolves.
double resolved_share(double strain);

/// (E62), half a step on: before P2G to the middle of the step, after G2P to its end.
template <int Dim>
struct CarryGradient {
  static constexpr Doc doc = "(E62) velocity gradient, carried on by half a step";
  void operator()(Read<Clock> clock, Read<OccupiedCells<Dim>> cells, Read<cell::LiquidIndicator> w_c,
                  Update<particle::VelocityGradient<Dim>> grad_v_p) const;
};

/// (E62) in the conforming discretization, at the end of a step and on to the middle of the next.
template <int Dim>
struct CarryGradientByFaces {
  static constexpr Doc doc = "(E62) velocity gradient, carried on by a step";
  void operator()(Read<Clock> clock, Read<GridCells<Dim>> cells, Read<cell::LiquidIndicator> w_c,
                  Update<particle::VelocityGradient<Dim>> grad_v_p) const;
};

}  // namespace minamo
