#pragma once
/// \file
/// FMPM(k): particles take over the new grid velocity of a mass matrix that is nearer to the full one with rising order
/// k, so that less is damped. FMPM(1) is PIC; unlike XPIC it keeps nothing of what the grid does not see.
/// J. A. Nairn, arXiv:2604.07307 (2026). The change of the position update is not taken over: here particles move with
/// the displacement that was solved for.

#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/transfer/filter_series.hpp"

namespace minamo {

/// (E66)  v*_I = sum_{l<k} (1 - S^+ S)^l v_I^{n+1}, S and S^+ of (E46).
template <int Dim>
struct FilterVelocityFmpm {
  static constexpr Doc doc = "(E66) v*_I, FMPM";
  int order = 2;  ///< [1]

  FilterVelocityFmpm() = default;
  explicit FilterVelocityFmpm(int order_of_filter) : order(order_of_filter) {}
  explicit FilterVelocityFmpm(Input& input) : order(filter_order(input)) {}
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<node::Constraint> constraint,
                  Optional<Read<node::ConstraintFrame<Dim>>> frame, Read<node::NewVelocity<Dim>> v_i,
                  Write<node::Residue<Dim>> residue, Write<node::Smoothed<Dim>> smoothed,
                  Write<node::FilteredVelocity<Dim>> v_filtered) const;
};

/// (E66)  v_p = sum_I S_Ip v*_I.
template <int Dim>
struct G2PVelocityFmpm {
  static constexpr Doc doc = "(E66) v_p, FMPM";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::FilteredVelocity<Dim>> v_filtered,
                  Write<particle::Velocity<Dim>> v_p) const;
};

}  // namespace minamo
