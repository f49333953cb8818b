#include "systems/bodies/geometry/continue_liquid.hpp"

#include "systems/bodies/geometry/continuation.hpp"
#include "systems/liquid/side_of_face.hpp"
#include "systems/liquid/spread.hpp"

#include <cmath>

namespace minamo {

using liquid::farthest;
using liquid::is_cut;

namespace {

/// Open share of multipliers from which on their own particles tell where the surface is.
constexpr double telling_open = 0.1;
/// Newton's steps to where particles tell that the surface is, the largest of them, and what its area is told by.
/// [1, h, h]
constexpr int own_corrections = 3;
constexpr double largest_own_move = 0.2;
constexpr double for_area = 0.1;
/// Variance of how full particles tell that a multiplier is, over that of a continued surface. [h^-2]
constexpr double own_noise = 0.02;

/// Moves a continued surface to where the open part of its multiplier holds what was measured, by least squares: next
/// to no area tells next to nothing, and a wedge of few particles would have a surface that is not level.
template <int Dim>
void hold_own_volume(const SiteCuts<Dim>& cuts, double measured, KnownLiquid<Dim>& known) {
  const auto held = [&](double psi) { return cuts.open_below(known.site, psi, known.normal); };
  const double continued = known.psi;
  const double area = (held(continued + for_area) - held(continued - for_area)) / (2 * for_area);
  for (int k = 0; k < own_corrections; ++k) {
    const double towards = area * (measured - held(known.psi)) + own_noise * (continued - known.psi);
    const double move = towards / (area * area + own_noise);
    known.psi += std::clamp(move, -largest_own_move, largest_own_move);
    known.psi = std::clamp(known.psi, -farthest, farthest);
  }
}

/// Calls use(site) for the multipliers of the cells that a face reaches.
template <int Dim, class Use>
void for_each_multiplier_of_face(const Splines<Dim>& splines, const Index<Dim>& site, std::size_t d, const Use& use) {
  const int K = splines.degree;
  Index<Dim> begin;
  begin.fill(1 - K);
  Index<Dim> extent;
  extent.fill(2 * K - 1);
  --begin[d];
  ++extent[d];
  for_each_site_in_window<Dim>(splines, site, begin, extent, [&](const Index<Dim>& other) {
    if (splines.has_multiplier(other)) use(other);
  });
}

/// The multipliers that bodies cut, of the cells that faces with a share of exact integrals reach.
/// \return of rows, not 0 where such a face may be
template <int Dim>
std::vector<double> list_cut_multipliers(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows,
                                         std::span<const Index<Dim>> site,
                                         std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour,
                                         std::span<const double> open, std::span<const Vec<Dim>> share,
                                         const OpenSites<Dim>& open_sites, ContinuedLiquid<Dim>& continued) {
  // Most rows have no body near, and all others around: only those next to some that have not are looked at.
  const RowsOfSites<Dim> all{splines, rows, site, neighbour};
  const auto may_lack = [&](std::size_t i) { return open[i] < 1 || all.lacks_neighbour(i); };
  std::vector<double> is_near;
  with_degree(splines.degree, [&](auto degree) { is_near = near_any<Dim, degree()>(all, may_lack); });
  continued.rows.start(splines.sites());
  typename SiteRows<Dim>::Finder find(rows);
  const Index<Dim> sites = splines.sites();
  std::vector<std::uint8_t> is_looked_at(rows_in<Dim>(sites), 0);
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (is_near[i] == 0) continue;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (share[i][static_cast<Eigen::Index>(d)] == 0) continue;
      for_each_multiplier_of_face<Dim>(splines, site[i], d, [&](const Index<Dim>& other) {
        std::uint8_t& is_done = is_looked_at[row_in<Dim>(sites, other)];
        if (is_done == 0 && open_sites.share(other, find) < 1) continued.rows.add(other);
        is_done = 1;
      });
    }
  }
  continued.site.resize(continued.rows.number_rows());
  continued.rows.for_each([&](const Index<Dim>& at, std::uint32_t c) { continued.site[c] = at; });
  return is_near;
}

/// The sides around them, and place for a version of each.
/// \param has_sides  else all that is open hangs together
template <int Dim>
void find_versions(const OpenSites<Dim>& open, bool has_sides, ContinuedLiquid<Dim>& continued) {
  const std::size_t count = continued.site.size();
  continued.sides.assign(count, {});
  if (has_sides) {
    for_each_costly_row(count, [&](std::size_t c) { continued.sides[c] = find_sides<Dim>(open, continued.site[c]); });
  }
  continued.first.resize(count);
  continued.any_parted = false;
  std::size_t versions = 0;
  for (std::size_t c = 0; c < count; ++c) {
    continued.first[c] = static_cast<std::uint32_t>(versions);
    continued.any_parted = continued.any_parted || continued.sides[c].is_parted();
    versions += continued.versions(c);
  }
  continued.psi.assign(versions, -farthest);
  continued.fill.assign(versions, 0);
  continued.wetness.assign(versions, 0);
}

}  // namespace

template <int Dim>
void ContinueLiquid<Dim>::operator()(Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement,
                                     Read<StaticCut<Dim>> at_rest, Optional<Read<DrySides<Dim>>> dry,
                                     Read<StaggeredIndex<Dim>> rows, Read<multiplier::OpenShare> open,
                                     Read<face::Open<Dim>> open_face, Read<multiplier::Volume> v_l,
                                     Read<multiplier::Capacity> capacity, Optional<Read<SiteExchange>> shared,
                                     Update<face::ExactShare<Dim>> share, Update<multiplier::SurfaceDistance> psi,
                                     Update<multiplier::SurfaceNormal<Dim>> n_l, Update<multiplier::ContinuedFill> fill,
                                     Write<ContinuedLiquid<Dim>> continued) const {
  const PlacedBodies<Dim> bodies(placement, dry ? &*dry : nullptr);
  const SiteCuts<Dim> cuts(mac, *at_rest, bodies);
  const OpenSites<Dim> open_sites{*mac.splines, *rows, open.span(), open_face.span(), cuts};
  const std::vector<double> is_near = list_cut_multipliers<Dim>(
      *mac.splines, *rows, mac.site.span(), mac.neighbour.span(), open.span(), share.span(), open_sites, *continued);
  find_versions<Dim>(open_sites, placement.set->parts_liquid, *continued);
  const typename Continuation<Dim>::Columns columns{*mac.splines, *rows,      mac.site.span(), open.span(),
                                                    fill.span(),  psi.span(), n_l.span()};
  Continuation<Dim> continuation(columns, cuts, *continued);
  constexpr Index<Dim> here{};
  continuation.tell([&](KnownLiquid<Dim>& known, std::size_t c, std::size_t side) {
    const auto row = rows->find(known.site);
    if (!row || open[*row] < telling_open || v_l[*row] == 0) return false;
    if (continued->version(c, here) != std::optional<std::size_t>(continued->first[c] + side)) return false;
    if (!is_cut(known.fill)) return true;
    const double measured = v_l[*row] / capacity[*row] * open[*row];
    hold_own_volume(cuts, measured, known);
    known.fill = SplineFraction<Dim>(*mac.splines, known.site, known.normal)(known.psi).share;
    return true;
  });
  bool is_all_told = true;
  for (std::size_t v = 0; v < continued->psi.size(); ++v) {
    const KnownLiquid<Dim>* known = continuation.told(v);
    is_all_told = is_all_told && known != nullptr;
    if (known == nullptr) continue;
    continued->psi[v] = known->psi;
    continued->fill[v] = known->fill;
  }
  for_each_costly_row(continued->site.size(), [&](std::size_t c) {
    const auto row = rows->find(continued->site[c]);
    if (row && v_l[*row] > 0) return;
    for (std::size_t v = continued->first[c]; v < continued->first[c] + continued->versions(c); ++v) {
      const KnownLiquid<Dim>* known = continuation.told(v);
      if (known == nullptr || !is_cut(known->fill)) continue;
      typename SiteRows<Dim>::Finder find(*rows);
      const double whole = known->fill * open_sites.share(known->site, find);
      if (whole > 0) continued->wetness[v] = cuts.open_below(known->site, known->psi, known->normal) / whole;
    }
  });
  for (std::size_t c = 0; c < continued->site.size(); ++c) {
    const auto version = continued->version(c, here);
    const KnownLiquid<Dim>* known = version ? continuation.told(*version) : nullptr;
    const auto row = rows->find(continued->site[c]);
    if (known == nullptr || !row) continue;
    psi[*row] = known->psi;
    n_l[*row] = known->normal;
    if (fill[*row] > 0) fill[*row] = known->fill;  // without particles not all of its faces have rows
  }
  for_each_costly_row(is_all_told && !continued->any_parted ? 0 : mac.site.size(), [&](std::size_t i) {
    if (is_near[i] == 0) return;
    for (std::size_t d = 0; d < Dim; ++d) {
      double& of_face = share[i][static_cast<Eigen::Index>(d)];
      if (of_face == 0) continue;
      const Index<Dim> from = side_of_face<Dim>(*mac.splines, mac.site.span(), mac.neighbour.span(), open.span(), i, d);
      for_each_multiplier_of_face<Dim>(*mac.splines, mac.site[i], d, [&](const Index<Dim>& other) {
        const auto c = continued->rows.find(other);
        if (!c) return;
        const auto version = continued->version(*c, mac.splines->steps(other, from));
        if (!version || continuation.told(*version) == nullptr) of_face = 0;
      });
    }
  });
  if (!shared) return;
  shared->copy_from_owner(psi.span());
  shared->copy_from_owner(n_l.span());
  shared->copy_from_owner(fill.span());
  shared->copy_from_owner(share.span());
}

template struct ContinueLiquid<2>;
template struct ContinueLiquid<3>;

}  // namespace minamo
