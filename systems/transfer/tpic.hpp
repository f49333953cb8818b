#pragma once
/// \file
/// TPIC on nodes, for equal order; on faces it is in face_schemes.hpp. Particles carry a velocity and its gradient, the
/// first two terms of a Taylor series around them.
/// Nakamura, Matsumura, Mizutani, CMAME 403 (2023) 115720, doi:10.1016/j.cma.2022.115720.

#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// The option `spin` of TPIC: whether (E71) holds.
inline bool is_spin_conserved(Input& in) {
  return in.choice(
             "spin", std::vector<std::string>{"conserved", "gradient"},
             "rotation that particles carry: that of APIC, which keeps angular momentum (E71), or of the gradient "
             "(E18)",
             "conserved") == "conserved";
}

/// (E5) for the velocity.
template <int Dim>
struct P2GVelocityTpic {
  static constexpr Doc doc = "(E5) v_I^n, TPIC";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> grad_v_p, Write<node::Velocity<Dim>> v_i) const;
};

/// (E5) for the acceleration.
template <int Dim>
struct P2GAccelerationTpic {
  static constexpr Doc doc = "(E5) a_I^n, TPIC with newmark";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                  Read<particle::AccelerationGradient<Dim>> grad_a_p, Write<node::Acceleration<Dim>> a_i) const;
};

/// (E17), (E18)  v_p = sum_I S_Ip v_I^{n+1}, grad v_p = sum_I v_I^{n+1} (x) grad S_Ip; (E71) its antisymmetric part
/// that of APIC, so that away from walls particles take over the angular momentum of the grid.
template <int Dim>
struct G2PVelocityTpic {
  static constexpr Doc doc = "(E17) (E18) (E71) v_p and its gradient, TPIC";
  bool conserves_spin = true;  ///< (E71)

  G2PVelocityTpic() = default;
  explicit G2PVelocityTpic(Input& in);
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> grad_v_p) const;
};

/// (E17), (E18) for the acceleration.
template <int Dim>
struct G2PAccelerationTpic {
  static constexpr Doc doc = "(E17) (E18) a_p and its gradient, TPIC with newmark";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewAcceleration<Dim>> a_i,
                  Write<particle::Acceleration<Dim>> a_p, Write<particle::AccelerationGradient<Dim>> grad_a_p) const;
};

}  // namespace minamo
