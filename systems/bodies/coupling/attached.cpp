#include "systems/bodies/coupling/attached.hpp"

#include "systems/momentum/face_density.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
void FindAttachedMass<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Uses<BodyPlacement<Dim>> placement,
                                       Read<face::Open<Dim>> open, Read<face::OpenVolume<Dim>> open_volume,
                                       Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi,
                                       Optional<Read<face::Density<Dim>>> rho_f, Write<face::AttachedMass<Dim>> mass,
                                       Write<face::AttachedTo<Dim>> body) const {
  const PlacedBodies<Dim> bodies(placement);
  const SitePlaces<Dim> places(mac);
  const double cell_volume = std::pow(mac.grid->spacing, Dim);
  const FaceDensity<Dim> density{fluid->density, rho_f.span()};
  // Of the two multipliers of a face the one that bodies leave more of tells whether there is liquid; both, where they
  // leave as much but for rounding.
  const auto fill = [&](std::size_t i, std::size_t d) {
    constexpr double rounding = 1e-9;
    const std::int32_t below = mac.neighbour[i][2 * d];
    const double own = std::min(1.0, 2 * phi[i]);
    const double of_below = below == staggered::none ? 0 : std::min(1.0, 2 * phi[static_cast<std::size_t>(below)]);
    if (!mac.splines->has_multiplier(mac.site[i])) return of_below;
    if (mac.splines->ends_at(mac.site[i], 2 * d)) return own;
    const double more_below = 2 * (open_volume[i][static_cast<Eigen::Index>(d)] - share[i]);
    if (std::abs(more_below) < rounding) return 0.5 * (own + of_below);
    return more_below > 0 ? of_below : own;
  };
  for_each_costly_row(mac.site.size(), [&](std::size_t i) {
    mass[i].setZero();
    body[i].fill(-1);
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double attached = open_volume[i][axis] - open[i][axis];
      if (attached == 0 || !mac.splines->has_face(mac.site[i], d)) continue;
      const Vec<Dim> x = places.face(mac.site[i], d);
      const auto resting = bodies.nearest(x, false);
      const auto moving = bodies.nearest(x, true);
      body[i][d] = static_cast<std::int16_t>(moving.distance < resting.distance ? moving.body : resting.body);
      const double volume = cell_volume * mac.splines->face_integral(mac.site[i], d) * attached;
      mass[i][axis] = density.at(i, axis) * volume * fill(i, d);
    }
  });
}

template struct FindAttachedMass<2>;
template struct FindAttachedMass<3>;

}  // namespace minamo
