#include "systems/bodies/geometry/fill.hpp"

#include "systems/bodies/geometry/surface_level.hpp"
#include "systems/grid/filled_nodes.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/momentum/fill.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Open share from which on a multiplier tells whether the liquid around it is full: in less few particles tell little.
/// Rounding says nothing of one that is 0.4.
constexpr double telling_from = 0.4 - 1e-9;
constexpr double least_open_liquid = 1e-2;
/// Open share around a face from which on its own particles tell its mass. With those of faces next to it a thin layer
/// along a wall is too light, and a front runs ahead: the energy of a dam break between walls of a body along faces of
/// the grid rises by 1.5 of 61 J, with this by 0.15 J.
constexpr double enough_open = 0.3;
/// Open share below which a multiplier lies inside a body.
constexpr double inside_below = 1e-6;

}  // namespace

template <int Dim>
void FillNearBodies<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                     Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest,
                                     Optional<Read<DrySides<Dim>>> dry, Optional<Read<HiddenSites>> hidden,
                                     Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                                     Read<multiplier::OpenShare> share, Read<multiplier::Volume> v_l,
                                     Read<multiplier::Capacity> capacity, Update<multiplier::FillFraction> phi,
                                     Update<multiplier::FillAround> around, Update<multiplier::LeastFill> least) const {
  const PlacedBodies<Dim> bodies(placement, dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(*grid, *splines, *at_rest, bodies);
  const double cell_volume = std::pow(grid->spacing, Dim);
  struct Adjacent {
    Index<Dim> site;
    std::int32_t row;
    double share;  ///< of its volume, that bodies leave open
  };
  const auto adjacent = [&](std::size_t i, std::size_t side) -> Adjacent {
    const Index<Dim> at = *adjacent_site(*splines, site[i], side);
    std::int32_t j = neighbour[i][side];
    if (hidden && j != staggered::none && hidden->has_faces_alone(static_cast<std::size_t>(j))) j = staggered::none;
    return {at, j,
            j == staggered::none ? cuts.share_from_row(hidden ? &*hidden : nullptr, site.span(), i, at)
                                 : share[static_cast<std::size_t>(j)]};
  };
  const auto has_cut_empty = [&](std::size_t i) {
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const Adjacent other = adjacent(i, side);
      if (other.row == staggered::none && other.share < 1) return true;
    }
    return false;
  };
  for_each_costly_row(phi.size(), [&](std::size_t i) {
    if (!splines->has_multiplier(site[i]) || v_l[i] == 0) {  // not all of its faces have rows
      phi[i] = around[i] = 0;
      return;
    }
    if (share[i] == 1 && !has_cut_empty(i)) return;
    if (share[i] < inside_below) {
      phi[i] = around[i] = 1;
      return;
    }
    double filled = 2 * v_l[i];
    double open = 2 * capacity[i];
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const Adjacent other = adjacent(i, side);
      if (other.row == staggered::none) {
        open += cell_volume * other.share * splines->widths(other.site);
      } else {
        filled += v_l[static_cast<std::size_t>(other.row)];
        open += capacity[static_cast<std::size_t>(other.row)];
      }
    }
    if (share[i] < 1) phi[i] = filled / open;
    around[i] = std::max(phi[i], filled / open);
  });
  for_each_costly_row(phi.size(), [&](std::size_t i) {
    if (!splines->has_multiplier(site[i])) return;
    least[i] = 0;
    if (v_l[i] == 0) return;
    least[i] = share[i] < telling_from ? 1 : around[i];
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const Adjacent other = adjacent(i, side);
      if (other.share < telling_from) continue;
      least[i] = std::min(least[i], other.row == staggered::none ? 0 : around[static_cast<std::size_t>(other.row)]);
    }
  });
}

template <int Dim>
void FindUncutMass<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Uses<BodyPlacement<Dim>> placement,
                                    Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry,
                                    Optional<Read<HiddenSites>> hidden, Read<StaggeredIndex<Dim>> rows,
                                    Read<face::Open<Dim>> open_face, Read<face::OpenVolume<Dim>> open_volume,
                                    Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi,
                                    Read<multiplier::LeastFill> least, Read<face::Mass<Dim>> m_f,
                                    Optional<Read<face::Density<Dim>>> rho_f, Optional<Read<SiteExchange>> shared,
                                    Write<face::UncutMass<Dim>> uncut) const {
  const PlacedBodies<Dim> bodies(placement, dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(mac, *at_rest, bodies);
  // Of the two multipliers of a face the one with more liquid counts more: above a surface nothing is cut away.
  const auto open_liquid = [&](std::size_t i, std::size_t d) {
    constexpr double of_empty = 1e-3;
    double liquid = 2 * of_empty;
    double open = liquid * open_volume[i][static_cast<Eigen::Index>(d)];
    for (const std::int32_t l : {static_cast<std::int32_t>(i), mac.neighbour[i][2 * d]}) {
      if (l == staggered::none) continue;
      const auto row = static_cast<std::size_t>(l);
      liquid += phi[row];
      open += phi[row] * share[row];
    }
    return open / liquid;
  };
  // Where no particle is, no row.
  const auto open_empty = [&](std::size_t from, const Index<Dim>& at, std::size_t d) {
    return cuts.open_volume(at, d, [&](const Index<Dim>& l) {
      return cuts.share_from_row(hidden ? &*hidden : nullptr, mac.site.span(), from, l);
    });
  };
  const bool hides_any = dry && dry->hides_any();
  // None if a thin wall parts either of its sites from that of the face.
  const auto adjacent_face = [&](std::size_t i, std::size_t side, const Index<Dim>& at, std::size_t d) {
    const std::int32_t j = mac.neighbour[i][side];
    if (!hides_any || !dry->has_view(mac.site[i])) return j;
    const auto row = rows->find(at);
    if (!row || dry->parts(mac.site[i], at)) return staggered::none;
    const auto below = adjacent_site(*mac.splines, mac.site[i], 2 * d);
    const auto below_at = adjacent_site(*mac.splines, at, 2 * d);
    if (below && below_at && dry->parts(*below, *below_at)) return staggered::none;
    return static_cast<std::int32_t>(*row);
  };
  for_each_costly_row(m_f.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      uncut[i][axis] = m_f[i][axis];
      if (open_volume[i][axis] == 1 || !mac.splines->has_face(mac.site[i], d)) continue;
      double open = open_liquid(i, d);
      const double from_adjacent = std::max(0.0, 1 - open / enough_open);
      for (std::size_t side = 0; side < 2 * Dim && from_adjacent > 0; ++side) {
        const auto adjacent = adjacent_site(*mac.splines, mac.site[i], side);
        if (side / 2 == d || !adjacent || !mac.splines->has_face(*adjacent, d)) continue;
        const std::int32_t j = adjacent_face(i, side, *adjacent, d);
        open += from_adjacent *
                (j == staggered::none ? open_empty(i, *adjacent, d) : open_liquid(static_cast<std::size_t>(j), d));
        uncut[i][axis] += j == staggered::none ? 0 : from_adjacent * m_f[static_cast<std::size_t>(j)][axis];
      }
      // Of a face that is lighter than its particles, a pressure makes more energy than it takes.
      uncut[i][axis] = std::max(uncut[i][axis] / std::max(open, least_open_liquid),
                                m_f[i][axis] / std::max(open_volume[i][axis], least_open_liquid));
    }
  });
  const FaceDensity<Dim> density{fluid->density, rho_f.span()};
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    std::vector<std::uint32_t> cut;
    for (std::size_t i = 0; i < m_f.size(); ++i) {
      if (open_volume[i][axis] == 1 || open_face[i][axis] == 0 || m_f[i][axis] == 0) continue;
      if (!mac.splines->has_face(mac.site[i], d)) continue;
      // Where the liquid fills the grid a face has the mass of a whole one, (E68).
      if (filled_indicator(least_fill_of_face<Dim>(*mac.splines, mac.site[i], mac.neighbour[i], least.span(), i, d)) <
          1)
        cut.push_back(static_cast<std::uint32_t>(i));
    }
    level_with_surface<Dim>({*mac.splines, *rows, mac.site.span(), open_volume.span(), share.span(), phi.span(),
                             m_f.span(), d, std::pow(mac.grid->spacing, Dim), density},
                            std::move(cut), uncut.span());
  }
  if (shared) shared->copy_from_owner(uncut.span());
}

template struct FindUncutMass<2>;
template struct FindUncutMass<3>;
template struct FillNearBodies<2>;
template struct FillNearBodies<3>;

}  // namespace minamo
