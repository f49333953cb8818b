#pragma once
/// \file
/// What openings do to the staggered grid: which faces they hold and at which velocity, which they leave open, how full
/// the grid is next to them, and the pressure outside.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/pressure/solve.hpp"

namespace minamo {

/// (E97)  Inflow holds the faces on its part of a side in every direction; the faces across free outflow are unknowns,
/// and outside is the pressure zero. Where outflow has a pressure or a level, liquid leaves straight: faces along the
/// side are held at rest.
template <int Dim>
struct OpenFaces {
  static constexpr Doc doc = "(E97) faces that openings hold, or leave open";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls, Read<OpeningSet<Dim>> set,
                  Read<staggered::Site<Dim>> site, Update<face::Held> held) const;
};

/// (E97)  v_f^n = w(x_f, t^n) on faces that inflow holds.
template <int Dim>
struct HoldInflow {
  static constexpr Doc doc = "(E97) v_f^n of inflow";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls,
                  Read<OpeningSet<Dim>> set, Read<staggered::Site<Dim>> site, Update<face::Velocity<Dim>> v_f) const;
};

/// (E97)  w_f at the instant of the balances.
template <int Dim>
struct PrescribeInflow {
  static constexpr Doc doc = "(E97) w_f of inflow in the balances";
  void operator()(Read<Clock> clock, Read<Rates> rates, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                  Read<Walls<Dim>> walls, Read<OpeningSet<Dim>> set, Read<staggered::Site<Dim>> site,
                  Write<opening::Velocities<Dim>> velocities, Write<face::Prescribed<Dim>> w_f) const;
};

/// (E97)  s_f already says what bodies at rest leave of a face that inflow holds: a_f is what moving ones leave of
/// that.
template <int Dim>
struct PassInflow {
  static constexpr Doc doc = "(E97) what bodies leave open of faces that inflow holds";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls, Read<OpeningSet<Dim>> set,
                  Read<staggered::Site<Dim>> site, Read<face::Closed<Dim>> closed, Update<face::Open<Dim>> open) const;
};

/// (E98)  Particles that lie nearer to an opening than their size a are where a lattice ends: what a sum over it misses
/// or has too much, (s/a - 1/2) V_p N_l on the side at a distance s, is added to V~_l. Particles that are outside in
/// the middle of the step count nothing. What particles bring of (E63) is in proportion.
template <int Dim>
struct FillAtOpenings {
  static constexpr Doc doc = "(E98) V~_l at openings, where lattices end";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<OpeningSet<Dim>> set,
                  Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Volume> V_p, Optional<Read<SiteExchange>> shared, Update<multiplier::Volume> v_l,
                  Update<multiplier::DivergenceAhead> ahead_l) const;
};

/// (E99)  v*_f gets tau F_f/m_f of the pressure outside, F_f = -n int N_f p dA; of what comes in p is less by
/// rho |v^n|^2/2 where it is that of liquid at rest, not where it is static. Where the grid is emptier than what is
/// under the level outside, in proportion.
template <int Dim>
struct PushAtOpenings {
  static constexpr Doc doc = "(E99) pressure outside openings";
  void operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<OpeningSet<Dim>> set,
                  Read<multiplier::FillFraction> phi, Read<face::Velocity<Dim>> v_f, Read<face::Mobility<Dim>> mobility,
                  Write<face::OutsideForce<Dim>> F_f, Update<face::Predictor<Dim>> predictor) const;
};

/// Velocities on the sides of openings whose faces are unknowns; (E100) the work done in all openings, dt sum_f F_f v_f
/// of the pressure outside and, where faces are held, dt sum_f (m_f ((v^{n+1} - v^n)/dt - b) - a_f (B^T lambda)_f) w_f;
/// near bodies a_f F_f is the force outside.
template <int Dim>
struct TakeOpeningVelocities {
  static constexpr Doc doc = "(E100) velocities in openings, and the work done there";
  void operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<Walls<Dim>> walls, Read<OpeningSet<Dim>> set,
                  Read<BodyForce> b, Read<face::Mass<Dim>> m_f, Read<face::OutsideForce<Dim>> F_f,
                  Read<face::Velocity<Dim>> v_old, Read<face::BalanceVelocity<Dim>> v_f,
                  Read<face::NewVelocity<Dim>> v_new, Read<multiplier::Force> lambda,
                  Optional<Read<face::Open<Dim>>> open, Optional<Read<SiteExchange>> shared,
                  Update<opening::Velocities<Dim>> velocities, Update<opening::EnergyIn> energy,
                  Write<opening::StepWork> work) const;
};

/// Rejects the step if inflow presses liquid into a full enclosure without a way out: its balance of mass has no
/// solution.
/// \throws StepRejected naming the rate
template <int Dim>
struct RequireOutlet {
  static constexpr Doc doc = "reject the step if what comes in has no way out";
  void operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<face::Prescribed<Dim>> w_f,
                  Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                  Read<unknown::Staggered> of_unknown, Read<unknown::NullVector> n_l,
                  Read<MultiplierSolver<Dim>> solver) const;
};

}  // namespace minamo
