#include "systems/bodies/geometry/dry_sides.hpp"

#include "systems/bodies/geometry/images.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Where liquid may meet a body, in the frame of its shape: one at rest in the grid alone. A periodic axis goes on
/// beyond both ends.
template <int Dim>
Bounds<Dim> region_of(const BodyScene<Dim>& body, const Grid<Dim>& grid, int degree) {
  const double around = (degree + 1) * grid.spacing;
  const Bounds<Dim> shape = body.shape->bounds();
  Bounds<Dim> region;
  for (int d = 0; d < Dim; ++d) {
    const double beyond = body.moves()                                 ? grid.high[d] - grid.low[d]
                          : grid.periodic[static_cast<std::size_t>(d)] ? around
                                                                       : 0;
    region.low[d] = grid.low[d] - beyond;
    region.high[d] = grid.high[d] + beyond;
    // What a moving body has around it moves with it.
    if (!body.moves() || !std::isfinite(shape.low[d]) || !std::isfinite(shape.high[d])) continue;
    // By whole cells, so that small cells lie the same in the mirror.
    const double length = shape.high[d] - shape.low[d] + 2 * around;
    const double margin = around + 0.5 * (std::ceil(length / grid.spacing - 1e-9) * grid.spacing - length);
    region.low[d] = shape.low[d] - margin;
    region.high[d] = shape.high[d] + margin;
  }
  return region;
}

/// What the thin walls of a body hide from the sites around.
/// \param stays  the body: views that nothing has changed near stay, too
template <int Dim>
void find_views(ThinWalls<Dim>& walls, const Shape<Dim>& shape, const Placement<Dim>& placement,
                const SitePlaces<Dim>& places, bool stays, typename DrySides<Dim>::Views& views) {
  const Index<Dim> sites = places.splines().sites();
  typename DrySides<Dim>::Views before;
  std::swap(before, views);
  std::vector<std::uint32_t> near;
  const auto middle_of = [&](std::size_t i) {
    const Bounds<Dim> box = places.box(index_in<Dim>(sites, i));
    return placement.to_body(Vec<Dim>(0.5 * (box.low + box.high)));
  };
  for (std::size_t i = 0; i < rows_in<Dim>(sites); ++i) {
    if (walls.may_hide_at(middle_of(i))) near.push_back(static_cast<std::uint32_t>(i));
  }
  if (near.empty()) return;
  // A body that moves has small cells beyond the sides of the grid, too, where no way leads around it.
  const Grid<Dim>& grid = places.grid();
  const auto is_in_grid = [&](const Vec<Dim>& in_body) {
    const Vec<Dim> at = placement.to_world(in_body);
    const double rounding = 1e-9 * grid.spacing;
    for (int d = 0; d < Dim; ++d) {
      if (grid.periodic[static_cast<std::size_t>(d)]) continue;
      if (at[d] < grid.low[d] - rounding || at[d] > grid.high[d] + rounding) return false;
    }
    return true;
  };
  if (!stays) walls.find_places(is_in_grid);
  std::vector<std::optional<typename DrySides<Dim>::View>> found(near.size());
  for_each_row(
      near.size(),
      [&](std::size_t k) {
        const Vec<Dim> x = middle_of(near[k]);
        const std::int32_t at = before.of_site.empty() ? -1 : before.of_site[near[k]];
        auto* const former = at >= 0 ? &before.list[static_cast<std::size_t>(at)] : nullptr;
        if (stays && former != nullptr && !walls.has_new_view_at(x)) {
          found[k] = std::move(*former);
        } else {
          found[k] = walls.view_from(shape, x, former);
        }
      },
      4);
  views.of_site.assign(rows_in<Dim>(sites), -1);
  for (std::size_t k = 0; k < near.size(); ++k) {
    if (!found[k]) continue;
    views.of_site[near[k]] = static_cast<std::int32_t>(views.list.size());
    views.list.push_back(std::move(*found[k]));
  }
}

/// Whether a wall parts a site from some of those around, but none of them from the next.
template <int Dim>
bool ends_near(const DrySides<Dim>& dry, const Splines<Dim>& splines, const Index<Dim>& site) {
  std::array<std::optional<Index<Dim>>, power(3, Dim)> around;
  std::array<std::size_t, power(3, Dim)> side;
  for_each_support<Dim>([&](std::size_t k, Index<Dim> offset) {
    for (int& steps : offset) --steps;
    const auto at = splines.site_at(site, offset);
    if (k != power(3, Dim) / 2 && at && splines.has_multiplier(*at)) around[k] = at;
    side[k] = k;
  });
  const auto side_of = [&](std::size_t k) {
    while (side[k] != k) k = side[k];
    return k;
  };
  for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (offset[d] == 0 || !around[k]) continue;
      const std::size_t below = k - power(3, static_cast<int>(d));
      if (around[below] && !dry.parts(*around[k], *around[below])) side[side_of(k)] = side_of(below);
    }
  });
  bool any_parted = false;
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < around.size(); ++k) {
    if (!around[k]) continue;
    if (first && side_of(k) != *first) return false;
    first = side_of(k);
    any_parted = any_parted || dry.parts(site, *around[k]);
  }
  return any_parted;
}

}  // namespace

template <int Dim>
std::optional<DrySides<Dim>> dry_sides_of(const BodySet<Dim>& set, const Grid<Dim>& grid, int degree) {
  DrySides<Dim> dry;
  for (const BodyScene<Dim>& body : set.bodies)
    dry.of_body.push_back(ThinWalls<Dim>::find(*body.shape, region_of<Dim>(body, grid, degree), grid.spacing, degree));
  const bool any = std::any_of(dry.of_body.begin(), dry.of_body.end(), [](const auto& walls) { return walls; });
  return any ? std::optional(std::move(dry)) : std::nullopt;
}

template <int Dim>
void FindDrySides<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Uses<BodyPlacement<Dim>> placement,
                                   Read<StaticCut<Dim>> at_rest, Read<particle::QuadraturePosition<Dim>> y_p,
                                   Optional<Read<Ranks>> ranks, Update<DrySides<Dim>> dry) const {
  const PlacedBodies<Dim> bodies(placement, &*dry);
  const SiteCuts<Dim> cuts(*grid, *splines, *at_rest, bodies);
  dry->sites = splines->sites();
  dry->views.resize(placement.set->bodies.size());
  std::vector<std::size_t> changed_at_rest;
  bool any_changed = false;
  for (std::size_t b = 0; b < placement.set->bodies.size(); ++b) {
    if (!dry->of_body[b]) continue;
    ThinWalls<Dim>& walls = *dry->of_body[b];
    const Shape<Dim>& shape = *placement.set->bodies[b].shape;
    for_each_costly_row(y_p.size(), [&](std::size_t p) {
      for_each_image<Dim>(*grid, y_p[p],
                          [&](const Vec<Dim>& y) { walls.light(shape, bodies.placement(b).to_body(y)); });
    });
    if (ranks) walls.share_light(*ranks->all);
    const bool has_changed = walls.find_dry();
    const bool moves = placement.set->bodies[b].moves();
    if (!has_changed && !(moves && walls.may_hide_any())) continue;
    any_changed = true;
    if (!moves) changed_at_rest.push_back(b);
    find_views<Dim>(walls, shape, bodies.placement(b), cuts.places(), !moves, dry->views[b]);
  }
  if (any_changed) {
    dry->is_at_end.assign(rows_in<Dim>(dry->sites), 0);
    for_each_costly_row(dry->is_at_end.size(), [&](std::size_t i) {
      const Index<Dim> site = index_in<Dim>(dry->sites, i);
      if (dry->has_view(site)) dry->is_at_end[i] = ends_near<Dim>(*dry, *splines, site) ? 1 : 0;
    });
  }
  if (at_rest->of.empty()) return;
  if (dry->at_rest.empty()) dry->at_rest = at_rest->of;
  if (changed_at_rest.empty()) return;
  const SitePlaces<Dim>& places = cuts.places();
  for_each_row(
      dry->at_rest.size(),
      [&](std::size_t i) {
        const Index<Dim> site = index_in<Dim>(at_rest->sites, i);
        const Bounds<Dim> box = places.box(site);
        const Vec<Dim> middle = 0.5 * (box.low + box.high);
        const bool has_changed = std::any_of(changed_at_rest.begin(), changed_at_rest.end(), [&](std::size_t b) {
          const Vec<Dim> in_body = bodies.placement(b).to_body(middle);
          return dry->of_body[b]->has_changed_near(in_body, places.reach()) ||
                 dry->of_body[b]->has_new_view_at(in_body);
        });
        if (has_changed) dry->at_rest[i] = cuts.cut_by_resting(site);
      },
      64);
}

template std::optional<DrySides<2>> dry_sides_of<2>(const BodySet<2>&, const Grid<2>&, int);
template std::optional<DrySides<3>> dry_sides_of<3>(const BodySet<3>&, const Grid<3>&, int);
template struct FindDrySides<2>;
template struct FindDrySides<3>;

}  // namespace minamo
