#pragma once
/// \file
/// What the volume projection may lift. Water that a step squeezes falls without gaining speed; pushed apart again it
/// is lifted without losing any. In the end both are the same, but an impact squeezes now what the correction lifts
/// later, when nothing else takes energy, and then the energy of the run rises. So a step may lift no more than it has
/// lost.

#include "components/advected_node.hpp"
#include "components/fluid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/sites.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// K^n of (E69), before the velocities change.
template <int Dim>
struct StoreKineticEnergy {
  static constexpr Doc doc = "(E69) K^n";
  void operator()(Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p, Write<EnergyBefore> before) const;
};

/// (E69)  d_I times min(1, max(0, L/W)) where W > 0: W = -sum_I rho V~_I b_I . d_I is what the shift lifts,
/// L = sum_I m_I b_I . u_I - (K^{n+1} - K^n) what the step has lost.
template <int Dim>
struct LimitShift {
  static constexpr Doc doc = "(E69) d_I, lifting no more than the step has lost";
  void operator()(Read<Fluid> fluid, Read<EnergyBefore> before, Read<particle::Mass> m_p,
                  Read<particle::Velocity<Dim>> v_p, Read<node::Mass> m_i, Read<node::BodyForce<Dim>> b_i,
                  Read<node::Displacement<Dim>> u_i, Read<node::Site<Dim>> sites, Read<AdvectedNodeIndex<Dim>> end_rows,
                  Read<advected_node::Volume> end_v_i, Update<node::Shift<Dim>> d_i) const;
};

}  // namespace minamo
