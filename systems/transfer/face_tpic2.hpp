#pragma once
/// \file
/// TPIC of second order on the staggered grid, as systems/transfer/tpic2.hpp says. Hats across have no second
/// derivative across within a cell, and need none: what a particle then brings from its place to the two faces next to
/// it is what they have.

#include "components/cells.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/input/input.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// (E3), (E64) on faces, with the spread of the knots of a face, s_f, in the place of D_p: the same inside, and at
/// walls still exact and without momentum.
template <int Dim>
struct P2GFacesTpic2 {
  static constexpr Doc doc = "(E3) (E64) m_f and v_f^n, TPIC of second order";
  void operator()(Uses<ParticlesToFaces<Dim>> source, Read<particle::Velocity<Dim>> v_p,
                  Read<particle::VelocityGradient<Dim>> grad_v_p, Read<particle::VelocityCurvature<Dim>> h_p,
                  Write<face::Mass<Dim>> m_f, Write<face::Velocity<Dim>> v_f) const;
};

/// (E17), (E65), (E72) on faces.
template <int Dim>
struct G2PFacesTpic2 {
  static constexpr Doc doc = "(E17) (E65) (E72) v_p and two derivatives, TPIC of second order";
  double share = 1;  ///< s [1]

  G2PFacesTpic2() = default;
  explicit G2PFacesTpic2(Input& in);
  void operator()(Uses<FacesToParticles<Dim>> target, Read<cell::BulkIndicator> b_c, Read<face::NewVelocity<Dim>> v_f,
                  Write<particle::Velocity<Dim>> v_p, Write<particle::VelocityGradient<Dim>> grad_v_p,
                  Write<particle::VelocityCurvature<Dim>> h_p) const;
};

}  // namespace minamo
