#pragma once
/// \file
/// TPIC of second order (ours): particles carry the second derivatives of the velocity, too, the third term of a Taylor
/// series around them. What TPIC damps is what that series leaves out. They are kept where the grid resolves them and
/// the liquid is around: without that a dam break gains energy from noise that nothing damps.

#include "components/cells.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// The option `share` of TPIC of second order, s of (E65). [1]
inline double curvature_share(Input& in) {
  return in.number(
      "share",
      {.doc = "share of the second derivatives that is kept; 0 is TPIC", .fallback = 1, .at_least = 0, .at_most = 1});
}

/// (E64)  v_I = sum_p S_Ip m_p (v_p + grad v_p r + sum_ab H_ab (r_a r_b - D_ab) / 2) / m_I, r = x_I - y_p,
/// D_p = sum_I S_Ip r (x) r, so that no term changes the momentum.
template <int Dim>
struct P2GVelocityTpic2 {
  static constexpr Doc doc = "(E64) v_I^n, TPIC of second order";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> grad_v_p, Read<particle::VelocityCurvature<Dim>> h_p,
                  Write<node::Velocity<Dim>> v_i) const;
};

/// (E17), (E65)  H_ab = k_p d_ab v, d_ab v = sum_I v_I^{n+1} d^2 S_Ip / dx_a dx_b, k_p = s b_c phi_p, b_c of (E61),
/// phi_p = |grad v|^2 / (|grad v|^2 + h^2 |d_ab v|^2), Frobenius norms. s = 0 is TPIC; k_p = 1 gives back whatever
/// quadratic field was taken, and damps nothing.
/// (E72)  grad v_p = grad v, (E18), with the spin of (1 - k_p) (C_p - grad v) added to its own: what H_p does not carry
/// of the angular momentum that (E71) takes over.
template <int Dim>
struct G2PVelocityTpic2 {
  static constexpr Doc doc = "(E17) (E65) (E72) v_p and two derivatives, TPIC of second order";
  double share = 1;  ///< s [1]

  G2PVelocityTpic2() = default;
  explicit G2PVelocityTpic2(Input& in);
  void operator()(Uses<NodesToParticles<Dim>> target, Read<cell::BulkIndicator> b_c, Read<node::NewVelocity<Dim>> v_i,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> grad_v_p,
                  Write<particle::VelocityCurvature<Dim>> h_p) const;
};

}  // namespace minamo
