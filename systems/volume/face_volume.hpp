#pragma once
/// \file
/// What keeps particles apart on the staggered grid: the shift of the volume projection, (E36) to (E38), and stirring,
/// both limited by (E124).

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/instant.hpp"
#include "components/liquid.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/volume/part_window.hpp"

namespace minamo {

namespace particle {

/// Displacement that corrects the volume around a particle. [m]
template <int Dim>
struct Shift : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.shift", "d_p", "m", Lifetime::scratch};
};

/// Displacement that takes a particle from where they lie close to where they do not. [m]
template <int Dim>
struct Stir : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.stir", "s_p", "m", Lifetime::scratch};
};

}  // namespace particle

/// The grid on which stirring counts particles: as many parts per cell and direction as there are particles.
struct StirGrid {
  int parts = 2;
  static constexpr ComponentInfo info{"stir.grid", "h/d", "1", Lifetime::constant};
};

/// (E74)  C = sum_p S V_p/d^Dim on the parts of cells, S quadratic B-splines of spacing d.
template <int Dim>
struct FillParts {
  static constexpr Doc doc = "(E74) fill fraction of the parts of cells";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells, Read<CellSites> sites,
                  Read<StirGrid> stir, Read<staggered::Neighbour<Dim>> neighbour,
                  Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                  Optional<Read<SiteExchange>> shared, Optional<Read<GhostCells<Dim>>> ghosts,
                  Read<StaggeredIndex<Dim>> index, Optional<Read<HiddenSites>> hidden, Write<PartFill> parts) const;
};

/// (E74)  s_p = q_p - mean of q over the particles of the cell, q = -5 dt |D| d^2 grad C, D the rate of strain in the
/// middle of the cell; only where all multipliers of the cell are more than 60 % full. A velocity without divergence at
/// every point never mixes what it stretches: columns of particles stay columns, with gaps between them wider than h.
/// Nothing at rest, and Galilean invariant. Without the mean, because C falls off towards the surface and stirring
/// would move it. Near bodies with what they fill, C + C_s.
template <int Dim>
struct StirParticles {
  static constexpr Doc doc = "(E74) s_p, away from where particles lie close";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<StirGrid> stir, Read<PartFill> parts, Optional<Read<SolidParts>> solid,
                  Read<multiplier::FillFraction> phi, Read<face::NewVelocity<Dim>> v_f,
                  Read<particle::QuadraturePosition<Dim>> y_p, Write<particle::Stir<Dim>> s_p) const;
};

/// (E38)  d_p = sum_f N_f d_f.
template <int Dim>
struct GatherFaceShift {
  static constexpr Doc doc = "(E38) d_p";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<face::Shift<Dim>> d_f,
                  Write<particle::Shift<Dim>> d_p) const;
};

/// (E36), (E37) on the staggered grid: the divergence that the shift is to have, from the volumes at y_p;
/// with bodies the share of it that the strain of the step asks for, as in (E124).
template <int Dim>
struct FillFaceVolumeSource {
  static constexpr Doc doc = "(E36) (E37) r E_l/V_l, source of the shift";
  void operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<VolumeRate> rate, Read<face::Velocity<Dim>> v_f,
                  Read<face::Mass<Dim>> m_f, Read<multiplier::FillFraction> phi,
                  Optional<Read<multiplier::OpenShare>> open, Read<multiplier::Volume> v_l,
                  Read<multiplier::Capacity> capacity, Optional<Read<ContinuedLiquid<Dim>>> continued,
                  Read<unknown::Staggered> of_unknown, Update<unknown::Source> source) const;
};

/// (E69) and (E124) over all that moves particles without a velocity, so that shift and stirring raise no energy, and
/// go on where a step has lost none.
template <int Dim>
struct LimitParticleShift {
  static constexpr Doc doc = "(E69) (E124) shifts lift no more than they lower and the step has lost";
  void operator()(Read<Clock> clock, Read<BodyForce> b, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                  Optional<Read<particle::BodyForce<Dim>>> b_p, Read<EnergyBefore> before,
                  Optional<Read<particle::VelocityGradient<Dim>>> grad_v, Optional<Read<body::Work>> W_b,
                  Optional<Read<body::OldWork>> W_old, Optional<Read<opening::StepWork>> W_o,
                  Optional<Read<SiteExchange>> shared, Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p,
                  Read<face::Mass<Dim>> m_f, Read<face::BodyForce<Dim>> b_f, Read<face::Displacement<Dim>> u_f,
                  Update<particle::Shift<Dim>> d_p, Update<particle::Stir<Dim>> s_p) const;
};

/// x_p += d_p + s_p, at most 0.1 h. Velocities do not change: with grad v s_p the energy would rise.
template <int Dim>
struct ApplyParticleShift {
  static constexpr Doc doc = "(E38) x_p, moved by d_p and s_p";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<particle::Shift<Dim>> d_p,
                  Read<particle::Stir<Dim>> s_p, Optional<Read<OpeningSet<Dim>>> openings,
                  Update<particle::Position<Dim>> x_p) const;
};

}  // namespace minamo
