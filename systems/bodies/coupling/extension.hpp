#pragma once
/// \file
/// (E87) Velocities of closed faces, on which particles near a body have weight: linear functions through those of
/// the open faces around, by least squares. So a liquid that moves along a plane wall or rests stays exact, and the
/// wall acts through the balance of mass alone. An open face counts as much as it has particles around: slopes to those
/// of next to none, beyond a surface, would throw the edge of a layer along the wall ahead. Where the open faces lie on
/// one side only and their velocities differ by much, as next to a fast body, such a function leads far away: a value
/// stays near those that it is made of.
///
/// (E110) Near a body that the liquid sticks to the function has the velocity of the body at the nearest point of its
/// surface, and faces close to it count as closed. With surface tension an open face counts as much as it has liquid:
/// where there is next to none its force makes a face fast.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/surface_tension.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/splines.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// How far beyond those of the open faces a closed one may move within a step, in units of h.
inline constexpr double beyond_open_faces = 0.1;

/// (E87)
template <int Dim>
struct FindFaceExtension {
  static constexpr Doc doc = "(E87) what velocities of closed faces are made of";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry,
                  Optional<Read<HiddenSites>> hidden, Read<GridCells<Dim>> cells, Read<CellSites> cell_sites,
                  Read<particle::Volume> V_p, Read<particle::QuadraturePosition<Dim>> y_p,
                  Optional<Read<SurfaceTension>> tension, Optional<Read<SiteExchange>> shared,
                  Read<staggered::Site<Dim>> site, Read<face::Held> held, Read<face::Open<Dim>> open,
                  Read<face::OpenVolume<Dim>> open_volume, Read<multiplier::OpenShare> share,
                  Write<FaceExtension<Dim>> extension) const;
};

/// (E87) of the velocity at the start of the step.
template <int Dim>
struct ExtendOldVelocity {
  static constexpr Doc doc = "(E87) v_f^n of closed faces";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b,
                  Update<FaceExtension<Dim>> extension, Update<face::Velocity<Dim>> v_f) const {
    extension->before.clear();
    for (const auto& at : extension->targets) extension->before.push_back(v_f[at.row][at.direction]);
    extension->apply(v_f.span(), beyond_open_faces * grid->spacing / clock->step,
                     [&](std::size_t b) { return rigid_vector<Dim>(V_b[b], omega_b[b]); });
  }
};

/// (E87) of the velocities that the balances give.
template <int Dim>
struct ExtendBalanceVelocity {
  static constexpr Doc doc = "(E87) v_f, w_f and d_f of closed faces";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<FaceExtension<Dim>> extension,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                  Update<face::BalanceVelocity<Dim>> v_f, Update<face::Damping<Dim>> w_f,
                  Update<face::Shift<Dim>> d_f) const {
    const double beyond = beyond_open_faces * grid->spacing;
    extension->apply(v_f.span(), beyond / clock->step,
                     [&](std::size_t b) { return rigid_vector<Dim>(V_b[b], omega_b[b]); });
    extension->apply(w_f.span(), beyond / clock->step);
    extension->apply(d_f.span(), beyond);
  }
};

}  // namespace minamo
