#pragma once
/// \file
/// How much of every face's spline is in the liquid, exactly below the surface that multipliers tell.

#include "components/body.hpp"
#include "components/fluids.hpp"
#include "components/liquid.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// The cells that the surface passes;  (E131)  psi_l so that they hold more of what was measured, and V^_f.
template <int Dim>
struct FindExactVolume {
  static constexpr Doc doc = "(E131) integrals of N_f over the liquid";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<StaggeredIndex<Dim>> rows,
                  Read<multiplier::ContinuedFill> phi, Read<multiplier::NearExact> near,
                  Read<multiplier::SurfaceNormal<Dim>> n_l, Read<face::Mass<Dim>> m_f,
                  Read<face::ExactShare<Dim>> share, Optional<Read<UnseenLiquid<Dim>>> unseen,
                  Optional<Read<ContinuedLiquid<Dim>>> continued, Optional<Read<multiplier::OpenShare>> open,
                  Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<SiteExchange>> shared,
                  Update<multiplier::SurfaceDistance> psi, Write<multiplier::Submerged<Dim>> submerged,
                  Write<SurfaceCells<Dim>> cells, Update<face::Mobility<Dim>> mobility,
                  Update<face::ExactVolume<Dim>> volume) const;
};

}  // namespace minamo
