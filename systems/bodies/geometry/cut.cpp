#include "systems/bodies/geometry/cut.hpp"

#include "systems/bodies/geometry/cut_site.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Closes faces of gaps between a moving body and a wall, or another body: what flows through one that is thinner than
/// a fraction of a cell is so fast, and weighs so little, that particles next to the gap would gain energy from it.
/// Gaps near bodies at rest stay.
template <int Dim>
void close_gaps(const SiteCuts<Dim>& cuts, std::span<const Index<Dim>> site,
                std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour, std::span<Vec<Dim>> open) {
  const Splines<Dim>& splines = cuts.places().splines();
  const auto is_gap = [&](std::size_t i, std::size_t d) {
    const auto axis = static_cast<Eigen::Index>(d);
    if (open[i][axis] == 0 || open[i][axis] >= sliver || open[i][axis] == cuts.by_resting(site[i]).open[axis])
      return false;
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const auto adjacent = adjacent_site(splines, site[i], side);
      if (side / 2 == d || !adjacent || !splines.has_face(*adjacent, d)) continue;
      const std::int32_t j = neighbour[i][side];
      const double share =
          j == staggered::none ? cuts.at(*adjacent).open[axis] : open[static_cast<std::size_t>(j)][axis];
      if (share >= sliver) return false;
    }
    return true;
  };
  std::vector<std::array<bool, static_cast<std::size_t>(Dim)>> gaps(open.size());
  for_each_costly_row(open.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) gaps[i][d] = is_gap(i, d);
  });
  for_each_row(open.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (gaps[i][d]) open[i][static_cast<Eigen::Index>(d)] = 0;
    }
  });
}

}  // namespace

template <int Dim>
SiteCut<Dim> SiteCuts<Dim>::cut_by_resting(const Index<Dim>& site) const {
  return cut_from(site, [&](const Vec<Dim>& x, const Index<Dim>& from) { return bodies_.distance(x, false, &from); });
}

template <int Dim>
template <class Distance>
SiteCut<Dim> SiteCuts<Dim>::cut_from(const Index<Dim>& site, const Distance& distance) const {
  const bool hides_any = bodies_.dry() != nullptr && bodies_.dry()->hides_any();
  const auto at_face = [&](const Vec<Dim>& x, std::size_t d) {
    const double from_site = distance(x, site);
    const auto below = hides_any ? adjacent_site(places_.splines(), site, 2 * d) : std::nullopt;
    return below ? std::max(from_site, distance(x, *below)) : from_site;
  };
  SiteCut<Dim> cut = cut_site<Dim>(
      places_, site, bodies_.bounded(), [&](const Vec<Dim>& x) { return distance(x, site); }, at_face);
  close_hidden(site, cut);
  return cut;
}

template <int Dim>
void SiteCuts<Dim>::close_hidden(const Index<Dim>& site, SiteCut<Dim>& cut) const {
  if (bodies_.dry() == nullptr || !bodies_.dry()->hides_any()) return;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto below = adjacent_site(places_.splines(), site, 2 * d);
    if (below && bodies_.dry()->parts(site, *below)) cut.open[static_cast<Eigen::Index>(d)] = 0;
  }
}

template <int Dim>
SiteCut<Dim> SiteCuts<Dim>::at(const Index<Dim>& site) const {
  const SiteCut<Dim> of_resting = by_resting(site);
  if (!bodies_.may_be_near(places_.middle(site), places_.reach())) return of_resting;
  return found_(row_in<Dim>(sites_, site), [&] {
    SiteCut<Dim> cut =
        cut_from(site, [&](const Vec<Dim>& x, const Index<Dim>& from) { return bodies_.distance_from(&from, x); });
    cut.open = cut.open.cwiseMin(of_resting.open);
    cut.share = std::min(cut.share, of_resting.share);
    return cut;
  });
}

template <int Dim>
double SiteCuts<Dim>::share_from(const Index<Dim>& from, const Index<Dim>& site) const {
  return detail::volume_share<Dim>(
      places_, site, bodies_.bounded(), [&](const Vec<Dim>& x) { return bodies_.distance_from(&from, x); },
      [](const Vec<Dim>&, double) { return 1.0; });
}

template <int Dim>
double SiteCuts<Dim>::share_from(std::span<const HiddenSites::Sight> side, std::span<const Index<Dim>> site_of_row,
                                 const Index<Dim>& site) const {
  int least = std::numeric_limits<int>::max();
  double sum = 0;
  int count = 0;
  for (const auto& [from, row] : side) {
    int square = 0;
    for (const int along : places_.splines().steps(site, site_of_row[row])) square += along * along;
    if (square > least) continue;
    if (square < least) sum = count = 0;
    least = square;
    sum += share_from(site_of_row[row], site);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

template <int Dim>
double SiteCuts<Dim>::share_from_row(const HiddenSites* hidden, std::span<const Index<Dim>> site_of_row,
                                     std::size_t row, const Index<Dim>& site) const {
  if (hidden != nullptr && hidden->is_hidden(row))
    return share_from(hidden->seen_from(HiddenSites::multiplier(row)), site_of_row, site);
  const DrySides<Dim>* dry = bodies_.dry();
  const bool is_hidden = dry != nullptr && dry->hides_any() && dry->parts(site_of_row[row], site);
  return is_hidden ? share_from(site_of_row[row], site) : at(site).share;
}

template <int Dim>
double SiteCuts<Dim>::open_below(const Index<Dim>& site, double psi, const Vec<Dim>& normal) const {
  const Grid<Dim>& grid = places_.grid();
  Vec<Dim> middle = grid.low;
  for (std::size_t d = 0; d < Dim; ++d)
    middle[static_cast<Eigen::Index>(d)] += grid.spacing * places_.splines().axis[d].place(site[d]);
  return detail::volume_share<Dim>(
      places_, site, bodies_.bounded(), [&](const Vec<Dim>& x) { return bodies_.distance_from(&site, x); },
      [&](const Vec<Dim>& x, double size) {
        return std::clamp(0.5 + (grid.spacing * psi + normal.dot(x - middle)) / size, 0.0, 1.0);
      });
}

template <int Dim>
void CutFaces<Dim>::operator()(Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest,
                               Optional<Read<DrySides<Dim>>> dry, Optional<Read<HiddenSites>> hidden,
                               Read<body::MeanVelocity<Dim>> V_b, Read<body::Velocity<Dim>> V_old,
                               Read<body::Spin<Dim>> omega_old, Read<body::MeanSpin<Dim>> omega_b,
                               Write<face::Open<Dim>> open, Write<face::OpenVolume<Dim>> open_volume,
                               Write<face::WallFlux<Dim>> flux, Write<face::OldWallFlux<Dim>> old_flux,
                               Write<face::Closed<Dim>> closed, Write<face::Closer<Dim>> closer,
                               Write<multiplier::OpenShare> share, Update<multiplier::Capacity> capacity) const {
  const PlacedBodies<Dim> bodies(placement, dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(mac, *at_rest, bodies);
  const SitePlaces<Dim>& places = cuts.places();
  const auto is_hidden = [&](std::size_t i) { return hidden && hidden->is_hidden(i); };
  const HiddenSites* of_hidden = hidden ? &*hidden : nullptr;
  const auto cut_of_hidden = [&](std::size_t i) {
    const double of_side =
        mac.splines->has_multiplier(mac.site[i]) ? cuts.share_from_row(of_hidden, mac.site.span(), i, mac.site[i]) : 1;
    return SiteCut<Dim>{Vec<Dim>::Zero(), of_side};
  };
  for_each_costly_row(mac.site.size(), [&](std::size_t i) {
    const SiteCut<Dim> cut = is_hidden(i) ? cut_of_hidden(i) : cuts.at(mac.site[i]);
    open[i] = cut.open;
    share[i] = cut.share;
    capacity[i] *= cut.share;
  });
  if (placement.set->any_moves()) close_gaps<Dim>(cuts, mac.site.span(), mac.neighbour.span(), open.span());
  // The nearest wall is the one that hides.
  const auto open_by_resting = [&](const Vec<Dim>& x) {
    return std::abs(bodies.distance(x, false)) < std::abs(bodies.distance(x, true)) ? 0.0 : 1.0;
  };
  for_each_costly_row(mac.site.size(), [&](std::size_t i) {
    flux[i].setZero();
    old_flux[i].setZero();
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double by_resting =
          is_hidden(i) ? open_by_resting(places.face(mac.site[i], d)) : cuts.by_resting(mac.site[i]).open[axis];
      closed[i][d] = {1 - by_resting, by_resting - open[i][axis]};
      closer[i][d] = {-1, -1};
      if (open[i][axis] == 1) continue;
      const Vec<Dim> x = places.face(mac.site[i], d);
      for (const bool moving : {false, true}) {
        if (closed[i][d][moving] == 0) continue;
        closer[i][d][moving] = static_cast<std::int16_t>(bodies.nearest(x, moving).body);
      }
      if (closer[i][d][1] < 0) continue;
      const auto b = static_cast<std::size_t>(closer[i][d][1]);
      const Vec<Dim> r = x - placement.c_b[b];
      flux[i][axis] = closed[i][d][1] * rigid_velocity(V_b[b], omega_b[b], r)[axis];
      old_flux[i][axis] = closed[i][d][1] * rigid_velocity(V_old[b], omega_old[b], r)[axis];
    }
  });
  for_each_costly_row(mac.site.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto share_of = [&](const Index<Dim>& at) {
        const std::int32_t below = mac.neighbour[i][2 * d];
        const std::int32_t row = at == mac.site[i] ? static_cast<std::int32_t>(i) : below;
        const bool has_row = row != staggered::none && !(is_hidden(static_cast<std::size_t>(row)) &&
                                                         hidden->has_faces_alone(static_cast<std::size_t>(row)));
        if (has_row) return share[static_cast<std::size_t>(row)];
        const std::size_t other = at == mac.site[i] && below != staggered::none ? static_cast<std::size_t>(below) : i;
        return cuts.share_from_row(of_hidden, mac.site.span(), other, at);
      };
      open_volume[i][static_cast<Eigen::Index>(d)] = cuts.open_volume(mac.site[i], d, share_of);
    }
  });
}

template class SiteCuts<2>;
template class SiteCuts<3>;
template struct CutFaces<2>;
template struct CutFaces<3>;

}  // namespace minamo
