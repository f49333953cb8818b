#pragma once
/// \file
/// (E120) The divergence that a velocity without divergence at the start of a step has at its middle, near bodies.
///
/// Inside the liquid the velocities of the start, over the places of the middle, have the divergence -dt/2 tr(grad v
/// grad v), the second term of (E63). Along a curved wall, and in front of one, they also lead through the wall, since
/// the liquid turns in half a step. Damping that takes this for an error holds the liquid back: without (E120) a
/// cylinder without friction has a drag coefficient of 1.6 instead of 0 on any grid.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E120) in the place of what particles bring to multipliers that bodies cut; with transfer schemes that carry a
/// gradient.
template <int Dim>
struct FindDivergenceAhead {
  static constexpr Doc doc = "(E120) divergence of the middle near bodies";
  void operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement,
                  Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p,
                  Read<particle::Velocity<Dim>> v_p, Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                  Read<face::Mass<Dim>> m_f, Read<face::Open<Dim>> open, Read<multiplier::OpenShare> share,
                  Read<multiplier::FillFraction> phi, Read<multiplier::Volume> v_l, Optional<Read<SiteExchange>> shared,
                  Update<multiplier::DivergenceAhead> ahead_l) const;
};

}  // namespace minamo
