#pragma once
/// \file
/// (E118) Density of faces and viscosity of cells where there are several liquids.

#include "components/cells.hpp"
#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "components/rheology.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/viscosity/cut_friction.hpp"

namespace minamo {

/// (E118)  rho_f = sum_p N_f m_p/sum_p N_f V_p.
template <int Dim>
struct FindFaceDensity {
  static constexpr Doc doc = "(E118) density of the liquids around faces";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells, Read<CellSites> sites,
                  Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p, Read<particle::Volume> V_p,
                  Optional<Read<SiteExchange>> shared, Write<face::LiquidVolume<Dim>> V_f,
                  Write<face::Density<Dim>> rho_f) const;
};

/// (E118)  mu_c = sum_k V_k/sum_k (V_k/mu_k) over the liquids of a cell, mu_k of a liquid by (E96) where it depends on
/// the shear rate, times what of the cell is liquid, as in (E80).
template <int Dim>
struct FindCellViscosityOfFluids {
  static constexpr Doc doc = "(E118) mu_c of several liquids";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluids> fluids, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<particle::Volume> V_p, Read<particle::FluidIndex> k_p,
                  Optional<Read<particle::ShearRate>> g_p, Optional<Read<particle::Viscosity>> mu_p,
                  Read<multiplier::FillAround> around, Optional<Read<CutFriction<Dim>>> cut,
                  Optional<Read<FrictionAtRest<Dim>>> at_rest, Write<cell::Viscosity> mu_c) const;
};

}  // namespace minamo
