#pragma once
/// \file
/// Where the surface of the liquid is: signed distances of multipliers, from how full they are.

#include "components/body.hpp"
#include "components/liquid.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

namespace liquid {

/// A multiplier is full above 1 - `edge` and empty below `edge`: nearer to either, the noise of particles moves the
/// surface by more than it is worth.
inline constexpr double edge = 1e-3;
/// The largest |psi_l| of what continues the liquid into bodies, and of what is full or empty far from the surface.
inline constexpr double farthest = 1.2;
inline bool is_full(double phi) { return phi >= 1 - edge; }
inline bool is_cut(double phi) { return phi > edge && phi < 1 - edge; }

/// Whether the surface may pass a cell of a multiplier.
/// \param neighbour  of the row of the multiplier
/// \param site       of the multiplier
template <int Dim>
bool may_be_at_surface(const Splines<Dim>& splines, const Index<Dim>& site,
                       const typename staggered::Neighbour<Dim>::value_type& neighbour, std::span<const double> phi,
                       std::size_t row) {
  if (!is_full(phi[row])) return is_cut(phi[row]);
  for (std::size_t side = 0; side < 2 * Dim; ++side) {
    if (splines.ends_at(site, side)) continue;
    const std::int32_t j = neighbour[side];
    if (j == staggered::none || !is_full(phi[static_cast<std::size_t>(j)])) return true;
  }
  return false;
}

}  // namespace liquid

/// (E130)  psi_l and n_l from phi_l, where faces have a share of exact integrals; not of multipliers that bodies cut.
template <int Dim>
struct FindLiquidSurface {
  static constexpr Doc doc = "(E130) signed distance of multipliers from the surface";
  void operator()(Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                  Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::FillFraction> phi,
                  Optional<Read<multiplier::OpenShare>> open, Read<face::ExactShare<Dim>> share,
                  Optional<Read<DrySides<Dim>>> dry, Optional<Read<SiteExchange>> shared,
                  Write<multiplier::SurfaceDistance> psi, Write<multiplier::SurfaceNormal<Dim>> n_l,
                  Write<multiplier::NearExact> near, Write<multiplier::ContinuedFill> continued) const;
};

}  // namespace minamo
