#include "systems/bodies/geometry/dry_sides.hpp"

#include <algorithm>

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
    region.low[d] = shape.low[d] - around;
    region.high[d] = shape.high[d] + around;
  }
  return region;
}

/// use(y) for a point and its images beyond the ends of periodic axes that a body may have near.
template <int Dim, class Use>
void for_each_image(const Grid<Dim>& grid, const Vec<Dim>& x, const Use& use) {
  std::array<Vec<Dim>, power(3, Dim)> images;
  images[0] = x;
  std::size_t count = 1;
  for (int d = 0; d < Dim; ++d) {
    if (!grid.periodic[static_cast<std::size_t>(d)]) continue;
    const Vec<Dim> length = (grid.high[d] - grid.low[d]) * Vec<Dim>::Unit(d);
    for (std::size_t k = 0, before = count; k < before; ++k) {
      images[count++] = images[k] - length;
      images[count++] = images[k] + length;
    }
  }
  for (std::size_t k = 0; k < count; ++k) use(images[k]);
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
void FindDrySides<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodySet<Dim>> set,
                                   Read<StaticCut<Dim>> at_rest, Read<body::MiddlePosition<Dim>> c_b,
                                   Read<body::MiddleRotation<Dim>> R_b, Read<particle::QuadraturePosition<Dim>> y_p,
                                   Update<DrySides<Dim>> dry) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span(), &*dry);
  std::vector<std::size_t> changed_at_rest;
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    if (!dry->of_body[b]) continue;
    ThinWalls<Dim>& walls = *dry->of_body[b];
    const Shape<Dim>& shape = *set->bodies[b].shape;
    for_each_row(y_p.size(), [&](std::size_t p) {
      for_each_image<Dim>(*grid, y_p[p],
                          [&](const Vec<Dim>& y) { walls.light(shape, bodies.placement(b).to_body(y)); });
    });
    if (walls.find_dry() && !set->bodies[b].moves()) changed_at_rest.push_back(b);
  }
  if (at_rest->of.empty()) return;
  if (dry->at_rest.empty()) dry->at_rest = at_rest->of;
  if (changed_at_rest.empty()) return;
  const SiteCuts<Dim> cuts(*grid, *splines, *at_rest, bodies);
  const SitePlaces<Dim>& places = cuts.places();
  for_each_row(
      dry->at_rest.size(),
      [&](std::size_t i) {
        const Index<Dim> site = index_in<Dim>(at_rest->sites, i);
        const Bounds<Dim> box = places.box(site);
        const Vec<Dim> middle = 0.5 * (box.low + box.high);
        const bool has_changed = std::any_of(changed_at_rest.begin(), changed_at_rest.end(), [&](std::size_t b) {
          return dry->of_body[b]->has_changed_near(middle, places.reach());
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
