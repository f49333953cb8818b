#pragma once
/// \file
/// The transfer schemes on the staggered grid. Every component of the velocity lives on faces of its own, so that a
/// particle brings component d, and its gradient, to the Greville points of the faces of direction d.

#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// (E3), (E4) on faces: m_f = sum_p N_f m_p, v_f = sum_p N_f m_p v_p / m_f.
template <int Dim>
struct P2GFacesPic {
  static constexpr Doc doc = "(E3) (E4) m_f and v_f^n, PIC";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p, Write<face::Mass<Dim>> m_f,
                  Write<face::Velocity<Dim>> v_f) const;
};

/// (E3), (E5) on faces, with the gradient that particles carry.
template <int Dim>
struct P2GFacesTpic {
  static constexpr Doc doc = "(E3) (E5) m_f and v_f^n, TPIC";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> grad_v_p, Write<face::Mass<Dim>> m_f,
                  Write<face::Velocity<Dim>> v_f) const;
};

/// (E17)  v_p = sum_f N_f v_f^{n+1}.
template <int Dim>
struct G2PFacesPic {
  static constexpr Doc doc = "(E17) v_p, PIC";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                  Write<particle::Velocity<Dim>> v_p) const;
};

/// (E16) on faces.
template <int Dim>
struct G2PFacesFlip {
  static constexpr Doc doc = "(E16) v_p, FLIP blended with PIC";
  double blend = 0.99;  ///< 1 is pure FLIP

  G2PFacesFlip() = default;
  explicit G2PFacesFlip(Input& input);
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::Velocity<Dim>> v_old,
                  Read<face::NewVelocity<Dim>> v_new, Update<particle::Velocity<Dim>> v_p) const;
};

/// (E17), (E18) on faces; (E71) the antisymmetric part of the gradient that of APIC.
template <int Dim>
struct G2PFacesTpic {
  static constexpr Doc doc = "(E17) (E18) (E71) v_p and its gradient, TPIC";
  bool conserves_spin = true;  ///< (E71)

  G2PFacesTpic() = default;
  explicit G2PFacesTpic(Input& input);
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> grad_v_p) const;
};

/// (E17), (E45) on faces.
template <int Dim>
struct G2PFacesApic {
  static constexpr Doc doc = "(E17) (E45) v_p and C_p, APIC";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewVelocity<Dim>> v_f,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> c_p) const;
};

/// (E4) on faces for the acceleration.
template <int Dim>
struct P2GFaceAccelerationPic {
  static constexpr Doc doc = "(E4) a_f^n, newmark";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Acceleration<Dim>> a_p, Read<face::Mass<Dim>> m_f,
                  Write<face::Acceleration<Dim>> a_f) const;
};

/// (E5) on faces for the acceleration.
template <int Dim>
struct P2GFaceAccelerationTpic {
  static constexpr Doc doc = "(E5) a_f^n, TPIC with newmark";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Acceleration<Dim>> a_p,
                  Read<particle::AccelerationGradient<Dim>> grad_a_p, Read<face::Mass<Dim>> m_f,
                  Write<face::Acceleration<Dim>> a_f) const;
};

/// (E17) on faces for the acceleration.
template <int Dim>
struct G2PFaceAccelerationPic {
  static constexpr Doc doc = "(E17) a_p, newmark";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewAcceleration<Dim>> a_f,
                  Write<particle::Acceleration<Dim>> a_p) const;
};

/// (E17), (E18) on faces for the acceleration.
template <int Dim>
struct G2PFaceAccelerationTpic {
  static constexpr Doc doc = "(E17) (E18) a_p and its gradient, TPIC with newmark";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewAcceleration<Dim>> a_f,
                  Write<particle::Acceleration<Dim>> a_p, Write<particle::AccelerationGradient<Dim>> grad_a_p) const;
};

/// (E17), (E45) on faces for the acceleration.
template <int Dim>
struct G2PFaceAccelerationApic {
  static constexpr Doc doc = "(E17) (E45) a_p and its affine part, APIC with newmark";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::NewAcceleration<Dim>> a_f,
                  Write<particle::Acceleration<Dim>> a_p, Write<particle::AccelerationGradient<Dim>> c_p) const;
};

/// (E11) on faces: x_p^{n+1} = x_p^n + sum_f N_f u_f.
template <int Dim>
struct AdvectByFaces {
  static constexpr Doc doc = "(E11) x_p; clamped at walls, counted";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::Displacement<Dim>> u_f,
                  Optional<Read<OpeningSet<Dim>>> openings, Update<particle::Position<Dim>> x_p,
                  Update<Clamped> clamped) const;
};

}  // namespace minamo
