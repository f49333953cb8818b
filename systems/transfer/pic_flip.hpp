#pragma once
/// \file
/// PIC and FLIP: particles carry a velocity, taken as constant around them.
/// Newmark's particle acceleration is transferred in the same way by both.

#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// The option `blend` of FLIP: its share, the rest is PIC. [1]
inline double flip_blend(Input& input) {
  return input.number("blend",
                      {.doc = "share of FLIP, the rest is PIC", .fallback = 0.99, .at_least = 0, .at_most = 1});
}

/// (E4) for the velocity.
template <int Dim>
struct P2GVelocityPic {
  static constexpr Doc doc = "(E4) v_I^n, PIC and FLIP";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Write<node::Velocity<Dim>> v_i) const;
};

/// (E4) for the acceleration.
template <int Dim>
struct P2GAccelerationPic {
  static constexpr Doc doc = "(E4) a_I^n, PIC and FLIP with newmark";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                  Write<node::Acceleration<Dim>> a_i) const;
};

/// (E17)  v_p = sum_I S_Ip v_I^{n+1}.
template <int Dim>
struct G2PVelocityPic {
  static constexpr Doc doc = "(E17) v_p, PIC";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                  Write<particle::Velocity<Dim>> v_p) const;
};

/// (E16)  v_p = alpha (v_p + sum_I S_Ip (v_I^{n+1} - v_I^n)) + (1 - alpha) sum_I S_Ip v_I^{n+1}.
template <int Dim>
struct G2PVelocityFlip {
  static constexpr Doc doc = "(E16) v_p, FLIP blended with PIC";
  double blend = 0.99;  ///< alpha [1]

  G2PVelocityFlip() = default;
  explicit G2PVelocityFlip(double blend_of_flip) : blend(blend_of_flip) {}
  explicit G2PVelocityFlip(Input& input);
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::Velocity<Dim>> v_old,
                  Read<node::NewVelocity<Dim>> v_new, Update<particle::Velocity<Dim>> v_p) const;
};

/// (E17) for the acceleration.
template <int Dim>
struct G2PAccelerationPic {
  static constexpr Doc doc = "(E17) a_p, PIC and FLIP with newmark";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewAcceleration<Dim>> a_i,
                  Write<particle::Acceleration<Dim>> a_p) const;
};

}  // namespace minamo
