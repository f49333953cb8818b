#pragma once
/// \file
/// What lumping the mass leaves out of the momentum balance.
///
/// The inertia that a node sees is sum_p S_Ip m_p a_p; (E25) has m_I a_I for it. With a_p = a_I + grad a_p (y_p - x_I)
/// the two differ by a first moment, which is zero in a full and even support and of order h at a free surface and at
/// walls. A consistent mass matrix has the moment and blows up in spray; here it comes from the step before:
/// (E53)  c_I = s sum_p w_c S_Ip m_p grad f_p (x_I - y_p) / m_I, added to the acceleration that forces give,
///        s = min(1, length of the step before / length of this one), w_c (E61);
/// (E54)  grad f_p = sum_J f_J (x) grad S_J(y_p), mean over a dual cell, f_I = (v_I^{n+1} - v_I^n)/dt - c_I.
/// s: an impact changes velocities by as much in a short step as in a long one; what it is worth must not be multiplied
/// by the ratio of the two. w: where few particles have nodes of their own, pressures answer the correction of the
/// step before by more than that, and velocity gradients would grow from step to step. sum_I m_I c_I = 0, so momentum
/// is kept. f and not f + c: the gradient would feed on itself in a lone particle. The mean over cells takes the noise
/// of single particles out. Ours; what TPIC (E5) does for velocities, for forces.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E53), into the right-hand side of (E25).
template <int Dim>
struct AddInertiaCorrection {
  static constexpr Doc doc = "(E53) first moment that lumping the mass leaves out";
  void operator()(Read<Clock> clock, Read<ForceStep> step, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                  Read<cell::Density> rho_c, Read<Moments<Dim>> moments, Read<cell::LiquidIndicator> w_c,
                  Read<particle::Mass> m_p, Read<particle::ForceGradient<Dim>> grad_f_p, Read<node::Row> row,
                  Read<node::Constraint> constraint, Optional<Read<node::ConstraintFrame<Dim>>> frame,
                  Read<node::Mass> m_i, Read<matrix::Node> node, Write<node::InertiaCorrection<Dim>> c_i,
                  Update<matrix::Momentum<Dim>> f) const;
};

/// (E54)
template <int Dim>
struct G2PForceGradient {
  static constexpr Doc doc = "(E54) grad f_p";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments,
                  Read<node::Velocity<Dim>> v_old, Read<node::NewVelocity<Dim>> v_new,
                  Read<node::InertiaCorrection<Dim>> c_i, Write<particle::ForceGradient<Dim>> grad_f_p,
                  Write<ForceStep> step) const;
};

}  // namespace minamo
