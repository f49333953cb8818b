#pragma once
/// \file
/// How well the conforming discretization keeps the volume.

#include "components/body.hpp"
#include "components/measure.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E31) on the staggered grid: max_l |(B v)_l|, v the velocity in the mass balance. The divergence of v at any point
/// is a mean of the (B v)_l around it.
template <int Dim>
struct MeasureFaceDivergence {
  static constexpr Doc doc = "(E31) largest divergence";
  void operator()(Uses<MacGrid<Dim>> mac, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<face::WallFlux<Dim>>> wall_flux, Optional<Read<SiteExchange>> shared,
                  Read<unknown::Staggered> of_unknown, Read<face::BalanceVelocity<Dim>> v_f,
                  Write<measure::MaxDivergence> largest) const;
};

/// (E32)  overlap = sum_l max(0, V~_l - V_l) / sum_p V_p, at y_p.
template <int Dim>
struct MeasureMultiplierOverlap {
  static constexpr Doc doc = "(E32) overlap";
  void operator()(Read<particle::Volume> V_p, Read<multiplier::Capacity> capacity, Read<multiplier::Volume> v_l,
                  Optional<Read<SiteExchange>> shared, Write<measure::Overlap> overlap) const;
};

/// (E43), (E44) on the staggered grid: p_s = sum_l N_l p_l, and of every component sum_f N_f v_f / sum_f N_f over the
/// faces with mass. Zero where the probe is dry.
template <int Dim, class Velocity>
struct MeasureProbesOnFacesIn {
  static constexpr Doc doc = "(E43), (E44) pressure and velocity at the probes";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<measure::Probes<Dim>> probes, Read<face::Mass<Dim>> m_f, Read<multiplier::Pressure> p_l,
                  Read<Velocity> v_f, Optional<Read<SiteExchange>> shared, Update<measure::Columns> columns) const;
};
template <int Dim>
using MeasureProbesOnFaces = MeasureProbesOnFacesIn<Dim, face::NewVelocity<Dim>>;
/// Before the first step the velocity is the one that the particles start with.
template <int Dim>
using MeasureProbesOnFacesAtStart = MeasureProbesOnFacesIn<Dim, face::Velocity<Dim>>;

}  // namespace minamo
