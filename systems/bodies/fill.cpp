#include "systems/bodies/fill.hpp"

#include "systems/bodies/surface_level.hpp"
#include "systems/conforming/fill.hpp"
#include "systems/conforming/sites_around.hpp"
#include "systems/grid/filled_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Open share from which on a multiplier tells whether the liquid around it is full: in less few particles tell little.
constexpr double telling_from = 0.4;
constexpr double least_open_liquid = 1e-2;
/// Open share around a face from which on its own particles tell its mass. With those of faces beside it a thin layer
/// along a wall is too light, and a front runs ahead: the energy of a dam break between walls of a body along faces of
/// the grid rises by 1.5 of 61 J, with this by 0.15 J.
constexpr double enough_open = 0.3;
/// Open share below which a multiplier lies inside a body.
constexpr double inside_below = 1e-6;

/// Open shares of sites that no particle touches.
template <int Dim>
class EmptySites {
 public:
  EmptySites(const SitePlaces<Dim>& places, const StaticCut<Dim>& at_rest, const PlacedBodies<Dim>& bodies)
      : places_(places), at_rest_(at_rest), bodies_(bodies) {}

  /// Open volume of the neighbour of a site towards a side, over that of a cell. \pre there is one
  double room(const Index<Dim>& of, std::size_t side) const {
    return share(of, side) * places_.splines().widths(*site_beside(places_.splines(), of, side));
  }
  /// Open share of that neighbour.
  double share(const Index<Dim>& of, std::size_t side) const {
    const Index<Dim> site = *site_beside(places_.splines(), of, side);
    const double by_resting = at_rest_.of.empty() ? 1 : at_rest_.at(site).share;
    const Bounds<Dim> box = places_.box(site);
    const Vec<Dim> x = 0.5 * (box.low + box.high);
    if (!bodies_.may_be_near(x, places_.reach())) return by_resting;
    return std::min(by_resting, bodies_.distance(x, true) < 0 ? 0.0 : 1.0);
  }

 private:
  const SitePlaces<Dim>& places_;
  const StaticCut<Dim>& at_rest_;
  const PlacedBodies<Dim>& bodies_;
};

}  // namespace

template <int Dim>
void FillBesideBodies<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodySet<Dim>> set,
                                       Read<StaticCut<Dim>> at_rest, Read<body::MiddlePosition<Dim>> c_b,
                                       Read<body::MiddleRotation<Dim>> R_b, Read<staggered::Site<Dim>> site,
                                       Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::OpenShare> share,
                                       Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                                       Update<multiplier::FillFraction> phi, Update<multiplier::FillAround> around,
                                       Update<multiplier::LeastFill> least) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const SitePlaces<Dim> places(*grid, *splines);
  const EmptySites<Dim> empty(places, *at_rest, bodies);
  const double cell_volume = std::pow(grid->spacing, Dim);
  for_each_row(phi.size(), [&](std::size_t i) {
    if (share[i] == 1) return;
    phi[i] = around[i] = 0;
    if (v_l[i] == 0) return;  // not all of its faces have rows
    if (share[i] < inside_below) {
      phi[i] = around[i] = 1;
      return;
    }
    double filled = 2 * v_l[i];
    double open = 2 * capacity[i];
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const std::int32_t j = neighbour[i][side];
      if (j == staggered::none) {
        open += cell_volume * empty.room(site[i], side);
      } else {
        filled += v_l[static_cast<std::size_t>(j)];
        open += capacity[static_cast<std::size_t>(j)];
      }
    }
    phi[i] = around[i] = filled / open;
  });
  for_each_row(phi.size(), [&](std::size_t i) {
    if (!splines->has_multiplier(site[i])) return;
    least[i] = share[i] < telling_from ? 1 : around[i];
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const std::int32_t j = neighbour[i][side];
      const bool is_empty = j == staggered::none;
      const double open = is_empty ? empty.share(site[i], side) : share[static_cast<std::size_t>(j)];
      if (open < telling_from) continue;
      least[i] = std::min(least[i], is_empty ? 0 : around[static_cast<std::size_t>(j)]);
    }
  });
}

template <int Dim>
void FindUncutMass<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                                    Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                                    Read<staggered::Neighbour<Dim>> neighbour, Read<face::Open<Dim>> open_face,
                                    Read<face::OpenVolume<Dim>> open_volume, Read<multiplier::OpenShare> share,
                                    Read<multiplier::FillFraction> phi, Read<multiplier::LeastFill> least,
                                    Read<face::Mass<Dim>> m_f, Optional<Read<face::Density<Dim>>> rho_f,
                                    Write<face::UncutMass<Dim>> uncut) const {
  // Of the two multipliers of a face the one with more liquid counts more: above a surface nothing is cut away.
  const auto open_liquid = [&](std::size_t i, std::size_t d) {
    constexpr double of_empty = 1e-3;
    double liquid = phi[i] + of_empty;
    double open = liquid * share[i];
    if (const std::int32_t below = neighbour[i][2 * d]; below != staggered::none) {
      const double under = phi[static_cast<std::size_t>(below)] + of_empty;
      liquid += under;
      open += under * share[static_cast<std::size_t>(below)];
    }
    return open / liquid;
  };
  for_each_row(m_f.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      uncut[i][axis] = m_f[i][axis];
      if (open_volume[i][axis] == 1) continue;
      double open = open_liquid(i, d);
      const double from_beside = std::max(0.0, 1 - open / enough_open);
      for (std::size_t side = 0; side < 2 * Dim; ++side) {
        if (side / 2 == d || neighbour[i][side] == staggered::none) continue;
        const auto j = static_cast<std::size_t>(neighbour[i][side]);
        open += from_beside * open_liquid(j, d);
        uncut[i][axis] += from_beside * m_f[j][axis];
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
      if (open_volume[i][axis] == 1 || open_face[i][axis] == 0 || !splines->has_face(site[i], d)) continue;
      // Where the liquid fills the grid a face has the mass of a whole one, (E68).
      if (filled_indicator(least_fill_of_face<Dim>(*splines, site[i], neighbour[i], least.span(), i, d)) < 1)
        cut.push_back(static_cast<std::uint32_t>(i));
    }
    level_with_surface<Dim>(
        {*splines, *rows, site.span(), open_volume.span(), share.span(), d, std::pow(grid->spacing, Dim), density},
        std::move(cut), uncut.span());
  }
}

template struct FindUncutMass<2>;
template struct FindUncutMass<3>;
template struct FillBesideBodies<2>;
template struct FillBesideBodies<3>;

}  // namespace minamo
