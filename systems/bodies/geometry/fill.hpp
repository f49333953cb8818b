#pragma once
/// \file
/// (E86) How full the grid is near bodies.

#include "components/body.hpp"
#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E86)  Near a body phi_l is that of the multiplier and its neighbours together, for few particles in a small open
/// volume tell little; inside a body nothing is missing, phi_l = 1.
template <int Dim>
struct FillNearBodies {
  static constexpr Doc doc = "(E86) fill fraction near bodies";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Uses<BodyPlacement<Dim>> placement,
                  Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry, Optional<Read<HiddenSites>> hidden,
                  Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                  Read<multiplier::OpenShare> share, Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                  Update<multiplier::FillFraction> phi, Update<multiplier::FillAround> around,
                  Update<multiplier::LeastFill> least) const;
};

/// (E86)  m_f over what bodies leave open of the liquid around a face; where that is little, with that of the faces
/// next to it. No less than m_f over what they leave open of the volume. (E123) near the free surface.
template <int Dim>
struct FindUncutMass {
  static constexpr Doc doc = "(E86) mass of faces, were nothing cut away";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Uses<BodyPlacement<Dim>> placement,
                  Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry, Optional<Read<HiddenSites>> hidden,
                  Read<StaggeredIndex<Dim>> rows, Read<face::Open<Dim>> open, Read<face::OpenVolume<Dim>> open_volume,
                  Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi,
                  Read<multiplier::LeastFill> least, Read<face::Mass<Dim>> m_f,
                  Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<SiteExchange>> shared,
                  Write<face::UncutMass<Dim>> uncut) const;
};

}  // namespace minamo
