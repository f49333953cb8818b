#pragma once
/// \file
/// XPIC(m): PIC whose filter, which damps what the grid does not see, leaves more and more alone with rising order m.
/// XPIC(1) is PIC; for large m only the null space of the transfer is damped, and the rest is FLIP.
/// C. C. Hammerquist, J. A. Nairn, CMAME 318 (2017) 724, doi:10.1016/j.cma.2017.01.035. Their change of the position
/// update is not taken over: here particles move with the displacement that was solved for.

#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/transfer/filter_series.hpp"

namespace minamo {

/// (E46)  v*_I = sum_{k<m} (1 - S^+ S)^k v_I^n, S grid to particles, S^+ the mass-weighted mean of (E4).
template <int Dim>
struct FilterVelocityXpic {
  static constexpr Doc doc = "(E46) v*_I, XPIC";
  int order = 2;  ///< [1]

  FilterVelocityXpic() = default;
  explicit FilterVelocityXpic(int order_of_filter) : order(order_of_filter) {}
  explicit FilterVelocityXpic(Input& input) : order(filter_order(input)) {}
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<node::Constraint> constraint,
                  Optional<Read<node::ConstraintFrame<Dim>>> frame, Read<node::Velocity<Dim>> v_i,
                  Write<node::Residue<Dim>> residue, Write<node::Smoothed<Dim>> smoothed,
                  Write<node::FilteredVelocity<Dim>> v_filtered) const;
};

/// (E47)  v_p = sum_I S_Ip (v*_I + v_I^{n+1} - v_I^n).
template <int Dim>
struct G2PVelocityXpic {
  static constexpr Doc doc = "(E47) v_p, XPIC";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::FilteredVelocity<Dim>> v_filtered,
                  Read<node::Velocity<Dim>> v_old, Read<node::NewVelocity<Dim>> v_new,
                  Write<particle::Velocity<Dim>> v_p) const;
};

}  // namespace minamo
