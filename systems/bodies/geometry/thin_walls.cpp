#include "systems/bodies/geometry/thin_walls.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/clip.hpp"
#include "systems/bodies/geometry/cut.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Pieces of a cell in which the far side of a wall is looked for.
constexpr int pieces_of_cell = 16;
/// How often the piece with the far side is halved.
constexpr int halvings_of_piece = 24;
/// What is dry is behind a wall by more than this. [h]
constexpr double detour = 1;

}  // namespace

template <int Dim>
ThinWalls<Dim>::ThinWalls(const Bounds<Dim>& region, double spacing, int thin)
    : region_(region), spacing_(spacing), thin_(thin) {
  const double half = 0.5 * spacing / fineness;
  low_ = region.low - Vec<Dim>::Constant(half);
  for (int d = 0; d < Dim; ++d)
    blocks_[static_cast<std::size_t>(d)] = static_cast<int>(std::ceil((region.high[d] + half - low_[d]) / spacing));
}

template <int Dim>
std::optional<ThinWalls<Dim>> ThinWalls<Dim>::find(const Shape<Dim>& shape, const Bounds<Dim>& region, double spacing,
                                                   int thin) {
  if ((region.high.array() <= region.low.array()).any()) return {};
  ThinWalls walls(region, spacing, thin);
  const std::size_t count = rows_in<Dim>(walls.blocks_);
  const double half_diagonal = 0.5 * spacing * std::sqrt(static_cast<double>(Dim));
  std::vector<std::uint8_t> is_thin(count, 0);
  for_each_row(
      count,
      [&](std::size_t block) {
        const Vec<Dim> middle = walls.middle_of_block(block);
        if (shape.is_bounded_by_distance() && std::abs(shape.distance(middle)) > half_diagonal) return;
        const double size = spacing / fineness;
        for (std::size_t k = 0; k < per_block && is_thin[block] == 0; ++k) {
          const Vec<Dim> x = walls.middle_within(block, k);
          const double distance = shape.distance(x);
          if (distance <= 0 || distance > 2 * size) continue;
          is_thin[block] = walls.thickness_at(shape, x, distance) < thin * spacing ? 1 : 0;
        }
      },
      16);
  if (std::none_of(is_thin.begin(), is_thin.end(), [](std::uint8_t is) { return is != 0; })) return {};
  walls.keep_blocks(is_thin);
  walls.join(shape);
  return walls;
}

template <int Dim>
bool ThinWalls<Dim>::is_inside(const Vec<Dim>& x) const {
  return (x.array() > region_.low.array()).all() && (x.array() < region_.high.array()).all();
}

template <int Dim>
double ThinWalls<Dim>::thickness_at(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const {
  const Vec<Dim> gradient = shape.gradient(x);
  const double none_thin = thin_ * spacing_;
  if (gradient.isZero(0)) return none_thin;
  const Vec<Dim> n = gradient.normalized();
  const Vec<Dim> surface = x - distance / gradient.squaredNorm() * gradient;
  const double piece = spacing_ / pieces_of_cell;
  double inside = 0;
  for (int k = 1; k <= pieces_of_cell * thin_; ++k) {
    double outside = k * piece;
    const Vec<Dim> far = surface - outside * n;
    if (!(shape.distance(far) > 0)) {
      inside = outside;
      continue;
    }
    if (!is_inside(far)) return none_thin;  // only the grid's side is behind it
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
void ThinWalls<Dim>::keep_blocks(const std::vector<std::uint8_t>& is_thin) {
  first_.assign(is_thin.size(), none);
  for (std::size_t block = 0; block < is_thin.size(); ++block) {
    if (is_thin[block] == 0) continue;
    const Index<Dim> at = index_in<Dim>(blocks_, block);
    Index<Dim> low;
    Index<Dim> sides;
    for (std::size_t d = 0; d < Dim; ++d) {
      low[d] = std::max(0, at[d] - reach());
      sides[d] = std::min(blocks_[d], at[d] + reach() + 1) - low[d];
    }
    for (std::size_t k = 0; k < rows_in<Dim>(sides); ++k) {
      Index<Dim> other = index_in<Dim>(sides, k);
      for (std::size_t d = 0; d < Dim; ++d) other[d] += low[d];
      first_[row_in<Dim>(blocks_, other)] = 0;
    }
  }
  for (std::size_t block = 0; block < first_.size(); ++block) {
    if (first_[block] == none) continue;
    first_[block] = static_cast<std::int32_t>(kept_.size() * per_block);
    kept_.push_back(static_cast<std::uint32_t>(block));
  }
  beside_.resize(kept_.size());
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      Index<Dim> at = index_in<Dim>(blocks_, kept_[k]);
      int& along = at[side / 2];
      along += side % 2 == 0 ? -1 : 1;
      beside_[k][side] = along < 0 || along >= blocks_[side / 2] ? none : first_[row_in<Dim>(blocks_, at)];
    }
  }
  const std::size_t count = kept_.size() * per_block;
  flags_.assign(count, 0);
  thickness_.assign(count, 0);
  is_lit_.assign(count, 0);
  was_lit_.assign(count, 0);
  is_dry_.assign(count, 0);
  has_changed_.assign(kept_.size(), 0);
}

template <int Dim>
void ThinWalls<Dim>::join(const Shape<Dim>& shape) {
  const double size = spacing_ / fineness;
  std::vector<double> distance(flags_.size());
  for_each_row(flags_.size(), [&](std::size_t s) {
    const Vec<Dim> x = middle_of_small(s);
    distance[s] = shape.distance(x);
    if (distance[s] > 0 && distance[s] < 2 * size)
      thickness_[s] = static_cast<float>(thickness_at(shape, x, distance[s]));
  });
  const auto distance_at = [&](const Vec<Dim>& x) { return shape.distance(x); };
  const auto faces_away = [&](const Vec<Dim>& a, const Vec<Dim>& b) {
    return shape.gradient(a).dot(shape.gradient(b)) < 0;
  };
  constexpr int most_halvings = 4;
  for_each_row(flags_.size(), [&](std::size_t s) {
    unsigned flags = distance[s] > 0 ? 1U << is_open : 0;
    const Vec<Dim> x = middle_of_small(s);
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const std::int32_t other = neighbour(s, side);
      if (other == none) continue;
      Vec<Dim> y = x;
      y[static_cast<Eigen::Index>(side / 2)] += side % 2 == 0 ? -size : size;
      const double at_y = distance[static_cast<std::size_t>(other)];
      if (!passes_through<Dim>(x, y, distance[s], at_y, most_halvings, distance_at, faces_away)) flags |= 1U << side;
    }
    flags_[s] = static_cast<std::uint8_t>(flags);
  });
  spread_thickness();
}

template <int Dim>
void ThinWalls<Dim>::spread_thickness() {
  std::vector<float> next;
  const int passes = reach() * fineness;
  for (int pass = 0; pass < passes; ++pass) {
    next = thickness_;
    for_each_row(flags_.size(), [&](std::size_t s) {
      if (thickness_[s] > 0 ? pass >= fineness / 2 : !has(s, is_open)) return;
      for (std::size_t side = 0; side < 2 * Dim; ++side) {
        const std::int32_t other = neighbour(s, side);
        const float there = other == none || !has(s, side) ? 0 : thickness_[static_cast<std::size_t>(other)];
        if (there > 0) next[s] = next[s] > 0 ? std::min(next[s], there) : there;
      }
    });
    thickness_.swap(next);
  }
}

template <int Dim>
Vec<Dim> ThinWalls<Dim>::middle_of_block(std::size_t block) const {
  const Index<Dim> at = index_in<Dim>(blocks_, block);
  Vec<Dim> x = low_ + Vec<Dim>::Constant(0.5 * spacing_);
  for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] += spacing_ * at[d];
  return x;
}

template <int Dim>
Vec<Dim> ThinWalls<Dim>::middle_within(std::size_t block, std::size_t within) const {
  Index<Dim> sides;
  sides.fill(fineness);
  const Index<Dim> at = index_in<Dim>(sides, within);
  const double size = spacing_ / fineness;
  Vec<Dim> x = middle_of_block(block) - Vec<Dim>::Constant(0.5 * (spacing_ - size));
  for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] += size * at[d];
  return x;
}

template <int Dim>
std::int32_t ThinWalls<Dim>::small_at(const Vec<Dim>& x) const {
  Index<Dim> block;
  std::size_t within = 0;
  for (std::size_t d = Dim; d-- > 0;) {
    const auto axis = static_cast<Eigen::Index>(d);
    const double along = (x[axis] - low_[axis]) / spacing_ * fineness;
    if (!(along >= 0 && along < static_cast<double>(blocks_[d]) * fineness)) return none;
    const int at = static_cast<int>(along);
    block[d] = at / fineness;
    within = within * fineness + static_cast<std::size_t>(at % fineness);
  }
  const std::int32_t first = first_[row_in<Dim>(blocks_, block)];
  return first == none ? none : first + static_cast<std::int32_t>(within);
}

template <int Dim>
std::int32_t ThinWalls<Dim>::neighbour(std::size_t small, std::size_t side) const {
  const std::size_t stride = power(fineness, static_cast<int>(side / 2));
  const std::size_t along = small % per_block / stride % fineness;
  const std::size_t last = fineness - 1;
  const auto s = static_cast<std::int32_t>(small);
  const auto step = static_cast<std::int32_t>(stride);
  if (side % 2 == 0 ? along > 0 : along < last) return side % 2 == 0 ? s - step : s + step;
  const std::int32_t block = beside_[small / per_block][side];
  if (block == none) return none;
  const auto across = static_cast<std::int32_t>(last) * step;  // to the opposite end of a block
  return block + s % static_cast<std::int32_t>(per_block) + (side % 2 == 0 ? across : -across);
}

template <int Dim>
std::int32_t ThinWalls<Dim>::telling(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const {
  const double size = spacing_ / fineness;
  if (distance >= size) return small_at(x);
  const Vec<Dim> gradient = shape.gradient(x);
  if (gradient.isZero(0)) return none;
  const std::int32_t small = small_at(x + (size - distance) / gradient.squaredNorm() * gradient);
  return small != none && has(static_cast<std::size_t>(small), is_open) ? small : none;
}

template <int Dim>
void ThinWalls<Dim>::light(const Shape<Dim>& shape, const Vec<Dim>& x) {
  if (small_at(x) == none) return;
  const double distance = shape.distance(x);
  if (distance < 0) return;
  const std::int32_t small = telling(shape, x, distance);
  if (small == none) return;
  std::atomic_ref<std::uint8_t>(is_lit_[static_cast<std::size_t>(small)]).store(1, std::memory_order_relaxed);
}

template <int Dim>
void ThinWalls<Dim>::spread(bool through_walls, int most, std::vector<std::int16_t>& steps) const {
  steps.assign(flags_.size(), -1);
  std::vector<std::int32_t> front;
  for (std::size_t s = 0; s < flags_.size(); ++s) {
    if (was_lit_[s] == 0) continue;
    steps[s] = 0;
    front.push_back(static_cast<std::int32_t>(s));
  }
  std::vector<std::int32_t> next;
  for (int step = 1; step <= most && !front.empty(); ++step) {
    next.clear();
    for (const std::int32_t s : front) {
      for (std::size_t side = 0; side < 2 * Dim; ++side) {
        if (!through_walls && !has(static_cast<std::size_t>(s), side)) continue;
        const std::int32_t other = neighbour(static_cast<std::size_t>(s), side);
        if (other == none || steps[static_cast<std::size_t>(other)] >= 0) continue;
        steps[static_cast<std::size_t>(other)] = static_cast<std::int16_t>(step);
        next.push_back(other);
      }
    }
    front.swap(next);
  }
}

template <int Dim>
bool ThinWalls<Dim>::find_dry() {
  const bool is_alike = is_lit_ == was_lit_;
  was_lit_ = is_lit_;
  std::fill(is_lit_.begin(), is_lit_.end(), std::uint8_t{0});
  if (is_alike) {
    std::fill(has_changed_.begin(), has_changed_.end(), std::uint8_t{0});
    return false;
  }
  constexpr int longer = static_cast<int>(detour * fineness);
  const int most = Dim * reach() * fineness;
  spread(true, most, through_);
  spread(false, most + longer, around_);
  bool any = false;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    has_changed_[k] = 0;
    for (std::size_t s = k * per_block; s < (k + 1) * per_block; ++s) {
      const bool is_behind = around_[s] < 0 || around_[s] > through_[s] + longer;
      const std::uint8_t is_dry = has(s, is_open) && through_[s] >= 0 && is_behind ? 1 : 0;
      if (is_dry != is_dry_[s]) has_changed_[k] = 1;
      is_dry_[s] = is_dry;
    }
    any = any || has_changed_[k] != 0;
  }
  return any;
}

template <int Dim>
double ThinWalls<Dim>::shaded(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const {
  if (small_at(x) == none) return distance;
  const std::int32_t small = telling(shape, x, distance);
  if (small == none || is_dry_[static_cast<std::size_t>(small)] == 0) return distance;
  return -distance - static_cast<double>(thickness_[static_cast<std::size_t>(small)]);
}

template <int Dim>
std::optional<typename ThinWalls<Dim>::Place> ThinWalls<Dim>::wet_on_both_sides(const Shape<Dim>& shape) const {
  const double size = spacing_ / fineness;
  const auto is_wet = [&](std::size_t s) { return around_[s] >= 0 && around_[s] <= fineness; };
  for (std::size_t s = 0; s < around_.size(); ++s) {
    const double thickness = static_cast<double>(thickness_[s]);
    if (thickness == 0 || thickness >= thin_ * spacing_ || !is_wet(s) || shape.distance(middle_of_small(s)) > size)
      continue;
    const Vec<Dim> x = middle_of_small(s);
    const Vec<Dim> n = shape.gradient(x).stableNormalized();
    const Vec<Dim> surface = x - shape.distance(x) * n;
    const std::int32_t opposite = small_at(surface - (thickness + size) * n);
    if (opposite != none && has(static_cast<std::size_t>(opposite), is_open) &&
        is_wet(static_cast<std::size_t>(opposite)))
      return Place{surface - 0.5 * thickness * n, thickness};
  }
  return {};
}

template <int Dim>
bool ThinWalls<Dim>::has_changed_near(const Vec<Dim>& x, double within) const {
  Index<Dim> low;
  Index<Dim> sides;
  for (std::size_t d = 0; d < Dim; ++d) {
    const double along = x[static_cast<Eigen::Index>(d)] - low_[static_cast<Eigen::Index>(d)];
    low[d] = std::max(0, static_cast<int>(std::floor((along - within) / spacing_)));
    sides[d] = std::min(blocks_[d], static_cast<int>(std::floor((along + within) / spacing_)) + 1) - low[d];
    if (sides[d] <= 0) return false;
  }
  for (std::size_t k = 0; k < rows_in<Dim>(sides); ++k) {
    Index<Dim> block = index_in<Dim>(sides, k);
    for (std::size_t d = 0; d < Dim; ++d) block[d] += low[d];
    const std::int32_t first = first_[row_in<Dim>(blocks_, block)];
    if (first != none && has_changed_[static_cast<std::size_t>(first) / per_block] != 0) return true;
  }
  return false;
}

template class ThinWalls<2>;
template class ThinWalls<3>;

}  // namespace minamo
