#pragma once
/// \file
/// (E135) The liquid goes on behind the walls of bodies: what of a spline that a body cuts is liquid, were it not
/// there.

#include "components/liquid.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// (E135)  psi_l, n_l and phi_l of multipliers that bodies cut: the mean of the planes of those around that none does,
/// moved to hold what the particles in the open part tell. Faces that reach where nothing is known have no share w_f.
template <int Dim>
struct ContinueLiquid {
  static constexpr Doc doc = "(E135) the liquid continued into bodies";
  void operator()(Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest,
                  Optional<Read<DrySides<Dim>>> dry, Read<StaggeredIndex<Dim>> rows, Read<multiplier::OpenShare> open,
                  Read<face::Open<Dim>> open_face, Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                  Optional<Read<SiteExchange>> shared, Update<face::ExactShare<Dim>> share,
                  Update<multiplier::SurfaceDistance> psi, Update<multiplier::SurfaceNormal<Dim>> n_l,
                  Update<multiplier::ContinuedFill> fill, Write<ContinuedLiquid<Dim>> continued) const;
};

}  // namespace minamo
