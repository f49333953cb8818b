#pragma once
/// \file
/// APIC: particles carry a velocity and the affine part of the grid velocity around them; what is angular momentum on
/// the grid stays on the particles. C. Jiang, C. Schroeder, A. Selle, J. Teran, A. Stomakhin, The affine
/// particle-in-cell method, ACM TOG 34 (2015) 51, doi:10.1145/2766996.
///
/// They carry B_p and use C_p = B_p D_p^-1 in the transfer to the grid. C_p is carried here, in the place of TPIC's
/// gradient, so that both schemes share (E5): D_p is h^2/4 away from walls, and in the half cell at a wall, where D_p
/// vanishes with the distance to the wall, C_p stays finite.

#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// (E17), (E45)  v_p = sum_I S_Ip v_I^{n+1}, C_p = sum_I S_Ip v_I^{n+1} (x) D_p^-1 (x_I - y_p).
template <int Dim>
struct G2PVelocityApic {
  static constexpr Doc doc = "(E17) (E45) v_p and C_p, APIC";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewVelocity<Dim>> v_i,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> c_p) const;
};

/// (E17), (E45) for the acceleration.
template <int Dim>
struct G2PAccelerationApic {
  static constexpr Doc doc = "(E17) (E45) a_p and its affine part, APIC with newmark";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::NewAcceleration<Dim>> a_i,
                  Write<particle::Acceleration<Dim>> a_p, Write<particle::AccelerationGradient<Dim>> c_p) const;
};

}  // namespace minamo
