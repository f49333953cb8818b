#pragma once
/// \file
/// (E96) Viscosity of particles and cells from how fast the liquid is sheared.

#include "components/cells.hpp"
#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "components/rheology.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/transfer/bundles.hpp"
#include "systems/viscosity/cut_friction.hpp"

namespace minamo {

/// (E96)  g_p = sqrt(2 D:D) of the velocity at the start of the step at y_p, and mu_p = mu(g_p), (E95); of grains with
/// the pressure of the last step, (E117).
template <int Dim>
struct ShearParticles {
  static constexpr Doc doc = "(E96) shear rate and viscosity at the start of the step";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<Rheology> rheology, Optional<Read<particle::FluidIndex>> k_p,
                  Optional<Read<particle::LastPressure>> p_p, Read<face::Velocity<Dim>> v_f,
                  Write<particle::ShearRate> g_p, Write<particle::Viscosity> mu_p) const;
};

/// (E96) of the velocity that the balances have given.
template <int Dim>
struct ShearParticlesAgain {
  static constexpr Doc doc = "(E96) shear rate and viscosity of the balances";
  void operator()(Uses<FacesToParticles<Dim>> target, Read<Rheology> rheology, Optional<Read<particle::FluidIndex>> k_p,
                  Optional<Read<particle::LastPressure>> p_p, Read<face::BalanceVelocity<Dim>> v_f,
                  Write<particle::ShearRate> g_p, Write<particle::Viscosity> mu_p) const;
};

/// (E96)  mu_c = sum_p V_p g_p^2 mu_p/sum_p V_p g_p^2, with which the cell dissipates what its particles do, times what
/// of the cell is liquid, as in (E80).
template <int Dim>
struct FindCellViscosityByParticles {
  static constexpr Doc doc = "(E96) mu_c of the viscosities of particles";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells, Read<CellSites> sites,
                  Read<particle::Volume> V_p, Read<particle::ShearRate> g_p, Read<particle::Viscosity> mu_p,
                  Read<multiplier::FillAround> around, Optional<Read<CutFriction<Dim>>> cut,
                  Optional<Read<FrictionAtRest<Dim>>> at_rest, Write<cell::Viscosity> mu_c) const;
};

/// (E117)  For the next step: the pressure that this one has found.
template <int Dim>
struct KeepPressure {
  static constexpr Doc doc = "(E117) p_p for the viscosity of the next step";
  void operator()(Read<particle::Pressure> found, Write<particle::LastPressure> p_p) const;
};

/// Before the loop: the velocities to compare with.
template <int Dim>
struct KeepBalanceVelocity {
  static constexpr Doc doc = "v_f before the viscosity is found again";
  void operator()(Read<face::BalanceVelocity<Dim>> v_f, Write<face::LastBalanceVelocity<Dim>> last) const;
};

/// (E96)  It is enough when no velocity changes by more than 1e-4 of the largest, or after `iterations` solves.
template <int Dim>
struct CompareBalanceVelocity {
  static constexpr Doc doc = "(E96) whether the viscosity fits the velocities";
  void operator()(Read<Rheology> rheology, Read<face::BalanceVelocity<Dim>> v_f, Optional<Read<SiteExchange>> shared,
                  Update<ViscosityLoop> loop, Update<face::LastBalanceVelocity<Dim>> last) const;
};

}  // namespace minamo
