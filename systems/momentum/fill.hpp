#pragma once
/// \file
/// How full of liquid the grid is, and what follows: which multipliers are unknowns, and with which mass faces resist.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/contact.hpp"
#include "components/fluids.hpp"
#include "components/liquid.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/surface_tension.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E35) at y_p: V~_l = sum_p N_l V_p, and what the second term of (E63) brings.
template <int Dim>
struct P2GMultipliers {
  static constexpr Doc doc = "(E35) (E63) volume and divergence of the middle around multipliers";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                  Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p, Optional<Read<SiteExchange>> shared,
                  Write<multiplier::Volume> v_l, Write<multiplier::DivergenceAhead> ahead_l) const;
};

/// The least fill of the multipliers below and above a face; at a wall there is one.
template <int Dim>
double least_fill_of_face(const Splines<Dim>& splines, const Index<Dim>& site,
                          const typename staggered::Neighbour<Dim>::value_type& neighbour,
                          std::span<const double> least, std::size_t row, std::size_t direction) {
  const double above = splines.has_multiplier(site) ? least[row] : 1;
  if (splines.ends_at(site, 2 * direction)) return above;
  const std::int32_t below = neighbour[2 * direction];
  return below == staggered::none ? 0 : std::min(above, least[static_cast<std::size_t>(below)]);
}

/// phi_l = V~_l/V_l;  (E125)  phi'_l = max(phi_l, (2 V~_l + sum_k V~_k)/(2 V_l + sum_k V_k)) with the neighbours k of a
/// multiplier, and the least phi' of both; beyond walls there are none.
template <int Dim>
struct FindFill {
  static constexpr Doc doc = "(E125) fill fraction of multipliers";
  void operator()(Read<Splines<Dim>> splines, Read<staggered::Site<Dim>> site,
                  Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::Volume> v_l,
                  Read<multiplier::Capacity> capacity, Optional<Read<HiddenSites>> hidden,
                  Optional<Read<SiteExchange>> shared, Write<multiplier::FillFraction> phi,
                  Write<multiplier::FillAround> around, Write<multiplier::LeastFill> least) const;
};

/// (E61) of a cell, f_c = sum_l V~_l/sum_l V_l over its multipliers.
template <int Dim>
struct FindLiquidCellsByMultipliers {
  static constexpr Doc doc = "(E61) w_c, b_c: liquid, spray or bulk";
  void operator()(Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells, Read<CellSites> sites,
                  Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity, Write<cell::LiquidIndicator> w_c,
                  Write<cell::BulkIndicator> b_c) const;
};

/// 1/m_f, by particles.
template <int Dim>
struct FindMobility {
  static constexpr Doc doc = "1/m_f, by particles";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid, Read<staggered::Site<Dim>> site,
                  Read<face::Held> held, Read<face::Mass<Dim>> m_f, Optional<Read<face::UncutMass<Dim>>> uncut,
                  Write<face::Mobility<Dim>> mobility) const;
};

/// (E68)  1/m_f with the mass of a full grid where the liquid fills it, of several liquids with (E118).
template <int Dim>
struct FindMobilityMixed {
  static constexpr Doc doc = "(E68) 1/m_f, inside the liquid that of a full grid";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<face::Held> held, Read<face::Mass<Dim>> m_f,
                  Read<multiplier::LeastFill> least, Optional<Read<face::UncutMass<Dim>>> uncut,
                  Optional<Read<face::Density<Dim>>> rho_f, Write<face::Mobility<Dim>> mobility) const;
};

/// (E78), (E134)  The active multipliers and the matrix S = B m^-1 B^T between them.
template <int Dim>
struct AssembleMultipliers {
  static constexpr Doc doc = "(E77) (E78) active multipliers, S = B m^-1 B^T";
  void operator()(Uses<MacGrid<Dim>> mac, Read<face::Mobility<Dim>> mobility, Read<multiplier::FillFraction> phi,
                  Optional<Read<face::Open<Dim>>> open, Optional<Read<multiplier::Released>> released,
                  Optional<Read<SurfaceTension>> tension, Optional<Read<multiplier::ContinuedFill>> continued,
                  Optional<Read<multiplier::OpenShare>> open_share, Optional<Read<HiddenSites>> hidden,
                  Resize<Unknowns> unknowns, Write<multiplier::Row> row, Write<unknown::Staggered> of_unknown,
                  Write<unknown::Site<Dim>> unknown_site, Write<unknown::Neighbour<Dim>> unknown_neighbour,
                  Write<unknown::Conductance<Dim>> conductance, Write<unknown::Diagonal> diagonal,
                  Write<unknown::NullVector> null_vector) const;
};

}  // namespace minamo
