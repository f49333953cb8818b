#pragma once
/// \file
/// (E126) Momentum that particles take from faces near bodies and that no pressure has given: the body has.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "components/step.hpp"
#include "components/transfer.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/grid/splines.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E126)  Force, torque and work of the momentum that particles get by the faces near a body, less that of the
/// balances and of the liquid that is attached. Not of free bodies, nor of separating ones, at which liquid that leaves
/// would pull.
template <int Dim>
struct CountClosedFaces {
  static constexpr Doc doc = "(E126) what faces near bodies give to particles, no pressure to the faces";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                  Read<FaceExtension<Dim>> extension, Read<VelocityOfParticles> of_particles, Read<BodySet<Dim>> set,
                  Read<staggered::Site<Dim>> site, Read<face::Held> held, Read<face::Mass<Dim>> m_f,
                  Read<face::Mobility<Dim>> mobility, Read<face::Open<Dim>> open,
                  Read<face::OpenVolume<Dim>> open_volume, Read<face::Closer<Dim>> closer,
                  Read<face::AttachedMass<Dim>> attached, Read<face::AttachedTo<Dim>> attached_to,
                  Read<face::Velocity<Dim>> v_old, Read<face::NewVelocity<Dim>> v_new,
                  Read<body::MiddlePosition<Dim>> c_b, Read<body::Velocity<Dim>> V_old, Read<body::Spin<Dim>> omega_old,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                  Optional<Read<SiteExchange>> shared, Update<body::Force<Dim>> F_b, Update<body::Torque<Dim>> T_b,
                  Update<body::Work> W_b) const;
};

}  // namespace minamo
