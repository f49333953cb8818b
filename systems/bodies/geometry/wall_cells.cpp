#include "systems/bodies/geometry/wall_cells.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/clip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace minamo {

namespace {

/// Pieces of a cell in which the far side of a wall is looked for.
constexpr int pieces_of_cell = 16;
/// How often the piece with the far side is halved.
constexpr int halvings_of_piece = 24;
/// What rounding may say of a point on a side of the region. [h]
constexpr double on_region_side = 1e-6;
/// A point nearer than this is on the body. [h]
constexpr double on_body = 1e-9;

}  // namespace

template <int Dim>
std::optional<WallCells<Dim>> WallCells<Dim>::find(const Shape<Dim>& shape, const Bounds<Dim>& region, double spacing,
                                                   int thin) {
  if ((region.high.array() <= region.low.array()).any()) return {};
  WallCells walls(region, spacing, thin);
  const std::size_t count = walls.cells_.blocks();
  const double half_diagonal = 0.5 * spacing * std::sqrt(static_cast<double>(Dim));
  std::vector<std::uint8_t> is_thin(count, 0);
  for_each_row(
      count,
      [&](std::size_t block) {
        const Vec<Dim> middle = walls.cells_.middle_of_block(block);
        if (shape.is_bounded_by_distance() && std::abs(shape.distance(middle)) > half_diagonal) return;
        const double size = walls.cells_.side();
        for (std::size_t k = 0; k < SmallCells<Dim>::per_block && is_thin[block] == 0; ++k) {
          const Vec<Dim> x = walls.cells_.middle_within(block, k);
          if (!walls.is_inside(x, -on_region_side * spacing)) continue;  // the last blocks go on beyond the region
          const double distance = shape.distance(x);
          if (distance <= on_body * spacing || distance > 2 * size) continue;
          is_thin[block] = walls.thickness_at(shape, x, distance) < thin * spacing ? 1 : 0;
        }
      },
      16);
  if (std::none_of(is_thin.begin(), is_thin.end(), [](std::uint8_t is) { return is != 0; })) return {};
  walls.cells_.keep(is_thin, walls.reach());
  walls.join(shape);
  return walls;
}

template <int Dim>
bool WallCells<Dim>::is_inside(const Vec<Dim>& x, double margin) const {
  return (x.array() > region_.low.array() + margin).all() && (x.array() < region_.high.array() - margin).all();
}

template <int Dim>
double WallCells<Dim>::thickness_at(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const {
  const Vec<Dim> gradient = shape.gradient(x);
  const double none_thin = thin_ * cells_.spacing();
  if (gradient.isZero(0)) return none_thin;
  const Vec<Dim> n = gradient.normalized();
  const Vec<Dim> surface = x - distance / gradient.squaredNorm() * gradient;
  const double piece = cells_.spacing() / pieces_of_cell;
  double inside = 0;
  for (int k = 1; k <= pieces_of_cell * thin_; ++k) {
    double outside = k * piece;
    const Vec<Dim> far = surface - outside * n;
    if (!(shape.distance(far) > 0)) {
      inside = outside;
      continue;
    }
    if (!is_inside(far, on_region_side * cells_.spacing())) return none_thin;  // only the grid's side is behind it
    for (int half = 0; half < halvings_of_piece; ++half) {
      const double middle = 0.5 * (inside + outside);
      (shape.distance(surface - middle * n) > 0 ? outside : inside) = middle;
    }
    // At an edge the ray leaves by the side that it has come in by, or along the other one.
    constexpr double faces_away = -0.1;
    return shape.gradient(far).normalized().dot(n) < faces_away ? outside : none_thin;
  }
  return none_thin;
}

template <int Dim>
void WallCells<Dim>::join(const Shape<Dim>& shape) {
  flags_.assign(cells_.size(), 0);
  thickness_.assign(cells_.size(), 0);
  const double size = cells_.side();
  std::vector<double> distance(flags_.size());
  std::vector<std::uint8_t> is_in(flags_.size());  // the last blocks go on beyond the region
  for_each_costly_row(flags_.size(), [&](std::size_t s) {
    const Vec<Dim> x = cells_.middle(s);
    distance[s] = shape.distance(x);
    if (std::abs(distance[s]) <= on_body * cells_.spacing()) distance[s] = 0;
    is_in[s] = is_inside(x, -on_region_side * cells_.spacing()) ? 1 : 0;
    if (is_in[s] == 0) return;
    if (distance[s] > 0 && distance[s] < 2 * size)
      thickness_[s] = static_cast<float>(thickness_at(shape, x, distance[s]));
  });
  for_each_costly_row(flags_.size(), [&](std::size_t s) {
    if (is_in[s] == 0) return;
    unsigned flags = distance[s] > 0 ? 1U << is_open_bit : 0;
    const Vec<Dim> x = cells_.middle(s);
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const std::int32_t other = cells_.neighbour(s, side);
      if (other == none || is_in[static_cast<std::size_t>(other)] == 0) continue;
      Vec<Dim> y = x;
      y[static_cast<Eigen::Index>(side / 2)] += side % 2 == 0 ? -size : size;
      const double at_y = distance[static_cast<std::size_t>(other)];
      if (!is_parted(shape, x, distance[s], y, at_y)) flags |= 1U << side;
    }
    flags_[s] = static_cast<std::uint8_t>(flags);
  });
  spread_thickness();
  find_opposites(shape);
}

template <int Dim>
void WallCells<Dim>::find_opposites(const Shape<Dim>& shape) {
  const double size = cells_.side();
  for (std::size_t s = 0; s < flags_.size(); ++s) {
    const double thickness = static_cast<double>(thickness_[s]);
    if (thickness == 0 || thickness >= thin_ * cells_.spacing() || !is_open(s)) continue;
    const Vec<Dim> x = cells_.middle(s);
    const double distance = shape.distance(x);
    if (distance > size) continue;
    const Vec<Dim> n = shape.gradient(x).stableNormalized();
    const std::int32_t other = cells_.at(Vec<Dim>(x - (distance + thickness + size) * n));
    if (other != none && is_open(static_cast<std::size_t>(other)))
      opposites_.push_back({static_cast<std::int32_t>(s), other});
  }
}

template <int Dim>
void WallCells<Dim>::spread_thickness() {
  std::vector<float> next;
  const int passes = reach() * SmallCells<Dim>::fineness;
  for (int pass = 0; pass < passes; ++pass) {
    next = thickness_;
    for_each_row(flags_.size(), [&](std::size_t s) {
      if (thickness_[s] > 0 ? pass >= SmallCells<Dim>::fineness / 2 : !is_open(s)) return;
      for (std::size_t side = 0; side < 2 * Dim; ++side) {
        const std::int32_t other = cells_.neighbour(s, side);
        const float there = other == none || !has(s, side) ? 0 : thickness_[static_cast<std::size_t>(other)];
        if (there > 0) next[s] = next[s] > 0 ? std::min(next[s], there) : there;
      }
    });
    thickness_.swap(next);
  }
}

template <int Dim>
std::int32_t WallCells<Dim>::telling(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const {
  const double size = cells_.side();
  if (distance >= size) return cells_.at(x);
  const Vec<Dim> gradient = shape.gradient(x);
  if (gradient.isZero(0)) return none;
  const Vec<Dim> outward = gradient / gradient.squaredNorm();
  const std::int32_t small = cells_.at(Vec<Dim>(x + (size - distance) * outward));
  if (small != none && is_open(static_cast<std::size_t>(small))) return small;
  return in_corner(shape, distance > 0 ? x : Vec<Dim>(x + (1e-3 * size - distance) * outward));
}

template <int Dim>
std::int32_t WallCells<Dim>::in_corner(const Shape<Dim>& shape, const Vec<Dim>& x) const {
  const auto middle = cells_.place_of(x);
  if (!middle) return none;
  constexpr int across = 5;
  Index<Dim> window;
  window.fill(across);
  const auto distance_at = [&](const Vec<Dim>& y) { return shape.distance(y); };
  const double at_x = distance_at(x);
  std::int32_t nearest = none;
  double least = std::numeric_limits<double>::infinity();
  double farthest = 0;
  const double tie = on_body * cells_.spacing() * cells_.spacing();
  for (std::size_t k = 0; k < rows_in<Dim>(window); ++k) {
    Index<Dim> place = index_in<Dim>(window, k);
    for (std::size_t d = 0; d < Dim; ++d) place[d] += (*middle)[d] - across / 2;
    const std::int32_t small = cells_.at(place);
    if (small == none || !is_open(static_cast<std::size_t>(small))) continue;
    const Vec<Dim> y = cells_.middle(static_cast<std::size_t>(small));
    const double square = (y - x).squaredNorm();
    const double at_y = distance_at(y);
    // Of two as near the one farther from the body: the same in the mirror.
    const bool is_tied = std::abs(square - least) < tie;
    if (is_tied ? at_y <= farthest : square > least) continue;
    if (is_parted(shape, x, at_x, y, at_y)) continue;
    least = square;
    farthest = at_y;
    nearest = small;
  }
  return nearest;
}

template <int Dim>
bool WallCells<Dim>::is_parted(const Shape<Dim>& shape, const Vec<Dim>& x, double at_x, const Vec<Dim>& y,
                               double at_y) const {
  constexpr int most_halvings = 4;
  return passes_through<Dim>(
      x, y, at_x, at_y, most_halvings, [&](const Vec<Dim>& z) { return shape.distance(z); },
      [&](const Vec<Dim>& a, const Vec<Dim>& b) { return shape.gradient(a).dot(shape.gradient(b)) < 0; });
}

template class WallCells<2>;
template class WallCells<3>;

}  // namespace minamo
