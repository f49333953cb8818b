#include "systems/bodies/geometry/thin_walls.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/clip.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/ranks/gathered.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

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
          if (!walls.is_inside(x, -on_region_side * spacing)) continue;  // the last blocks go on beyond the region
          const double distance = shape.distance(x);
          if (distance <= on_body * spacing || distance > 2 * size) continue;
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
bool ThinWalls<Dim>::is_inside(const Vec<Dim>& x, double margin) const {
  return (x.array() > region_.low.array() + margin).all() && (x.array() < region_.high.array() - margin).all();
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
    if (!is_inside(far, on_region_side * spacing_)) return none_thin;  // only the grid's side is behind it
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
  may_hide_.assign(kept_.size(), 0);
  has_new_view_.assign(kept_.size(), 0);
  around_.assign(count, -1);
}

template <int Dim>
void ThinWalls<Dim>::join(const Shape<Dim>& shape) {
  const double size = spacing_ / fineness;
  std::vector<double> distance(flags_.size());
  std::vector<std::uint8_t> is_in(flags_.size());  // the last blocks go on beyond the region
  for_each_row(flags_.size(), [&](std::size_t s) {
    const Vec<Dim> x = middle_of_small(s);
    distance[s] = shape.distance(x);
    if (std::abs(distance[s]) <= on_body * spacing_) distance[s] = 0;
    is_in[s] = is_inside(x, -on_region_side * spacing_) ? 1 : 0;
    if (is_in[s] == 0) return;
    if (distance[s] > 0 && distance[s] < 2 * size)
      thickness_[s] = static_cast<float>(thickness_at(shape, x, distance[s]));
  });
  for_each_row(flags_.size(), [&](std::size_t s) {
    if (is_in[s] == 0) return;
    unsigned flags = distance[s] > 0 ? 1U << is_open : 0;
    const Vec<Dim> x = middle_of_small(s);
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const std::int32_t other = neighbour(s, side);
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
void ThinWalls<Dim>::find_opposites(const Shape<Dim>& shape) {
  const double size = spacing_ / fineness;
  for (std::size_t s = 0; s < flags_.size(); ++s) {
    const double thickness = static_cast<double>(thickness_[s]);
    if (thickness == 0 || thickness >= thin_ * spacing_ || !has(s, is_open)) continue;
    const Vec<Dim> x = middle_of_small(s);
    const double distance = shape.distance(x);
    if (distance > size) continue;
    const Vec<Dim> n = shape.gradient(x).stableNormalized();
    const std::int32_t other = small_at(Vec<Dim>(x - (distance + thickness + size) * n));
    if (other != none && has(static_cast<std::size_t>(other), is_open))
      opposites_.push_back({static_cast<std::int32_t>(s), other});
  }
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
std::optional<Index<Dim>> ThinWalls<Dim>::place_of(const Vec<Dim>& x) const {
  Index<Dim> place;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    const double along = (x[axis] - low_[axis]) / spacing_ * fineness;
    if (!(along >= 0 && along < static_cast<double>(blocks_[d]) * fineness)) return {};
    place[d] = static_cast<int>(along);
  }
  return place;
}

template <int Dim>
Index<Dim> ThinWalls<Dim>::place_of(std::int32_t small) const {
  const auto s = static_cast<std::size_t>(small);
  Index<Dim> sides;
  sides.fill(fineness);
  Index<Dim> place = index_in<Dim>(blocks_, kept_[s / per_block]);
  const Index<Dim> within = index_in<Dim>(sides, s % per_block);
  for (std::size_t d = 0; d < Dim; ++d) place[d] = place[d] * fineness + within[d];
  return place;
}

template <int Dim>
std::int32_t ThinWalls<Dim>::small_at(const Index<Dim>& place) const {
  Index<Dim> block;
  std::size_t within = 0;
  for (std::size_t d = Dim; d-- > 0;) {
    if (place[d] < 0 || place[d] >= blocks_[d] * fineness) return none;
    block[d] = place[d] / fineness;
    within = within * fineness + static_cast<std::size_t>(place[d] % fineness);
  }
  const std::int32_t first = first_[row_in<Dim>(blocks_, block)];
  return first == none ? none : first + static_cast<std::int32_t>(within);
}

template <int Dim>
std::int32_t ThinWalls<Dim>::small_at(const Vec<Dim>& x) const {
  const auto place = place_of(x);
  return place ? small_at(*place) : none;
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
  const Vec<Dim> outward = gradient / gradient.squaredNorm();
  const std::int32_t small = small_at(Vec<Dim>(x + (size - distance) * outward));
  if (small != none && has(static_cast<std::size_t>(small), is_open)) return small;
  return in_corner(shape, distance > 0 ? x : Vec<Dim>(x + (1e-3 * size - distance) * outward));
}

template <int Dim>
std::int32_t ThinWalls<Dim>::in_corner(const Shape<Dim>& shape, const Vec<Dim>& x) const {
  const auto middle = place_of(x);
  if (!middle) return none;
  constexpr int across = 5;
  Index<Dim> window;
  window.fill(across);
  const auto distance_at = [&](const Vec<Dim>& y) { return shape.distance(y); };
  const double at_x = distance_at(x);
  std::int32_t nearest = none;
  double least = std::numeric_limits<double>::infinity();
  double farthest = 0;
  const double tie = on_body * spacing_ * spacing_;
  for (std::size_t k = 0; k < rows_in<Dim>(window); ++k) {
    Index<Dim> place = index_in<Dim>(window, k);
    for (std::size_t d = 0; d < Dim; ++d) place[d] += (*middle)[d] - across / 2;
    const std::int32_t small = small_at(place);
    if (small == none || !has(static_cast<std::size_t>(small), is_open)) continue;
    const Vec<Dim> y = middle_of_small(static_cast<std::size_t>(small));
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
bool ThinWalls<Dim>::is_parted(const Shape<Dim>& shape, const Vec<Dim>& x, double at_x, const Vec<Dim>& y,
                               double at_y) const {
  constexpr int most_halvings = 4;
  return passes_through<Dim>(
      x, y, at_x, at_y, most_halvings, [&](const Vec<Dim>& z) { return shape.distance(z); },
      [&](const Vec<Dim>& a, const Vec<Dim>& b) { return shape.gradient(a).dot(shape.gradient(b)) < 0; });
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
void ThinWalls<Dim>::share_light(Communicator& ranks) {
  std::vector<std::uint32_t> own;
  for (std::size_t s = 0; s < is_lit_.size(); ++s) {
    if (is_lit_[s] != 0) own.push_back(static_cast<std::uint32_t>(s));
  }
  for (const std::uint32_t s : gathered_on_all(ranks, std::span<const std::uint32_t>(own))) is_lit_[s] = 1;
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
    std::fill(has_new_view_.begin(), has_new_view_.end(), std::uint8_t{0});
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
  return find_two_sided() || any;
}

template <int Dim>
std::vector<std::uint8_t> ThinWalls<Dim>::blocks_near(const std::vector<std::uint8_t>& blocks, int within) const {
  std::vector<std::uint8_t> near(kept_.size(), 0);
  Index<Dim> window;
  window.fill(2 * within + 1);
  for (std::size_t kept = 0; kept < kept_.size(); ++kept) {
    if (blocks[kept] == 0) continue;
    const Index<Dim> block = index_in<Dim>(blocks_, kept_[kept]);
    for (std::size_t k = 0; k < rows_in<Dim>(window); ++k) {
      Index<Dim> place = index_in<Dim>(window, k);
      for (std::size_t d = 0; d < Dim; ++d) place[d] = (place[d] + block[d] - within) * fineness;
      const std::int32_t small = small_at(place);
      if (small != none) near[static_cast<std::size_t>(small) / per_block] = 1;
    }
  }
  return near;
}

template <int Dim>
bool ThinWalls<Dim>::find_two_sided() {
  std::vector<std::uint8_t> is_two_sided(kept_.size(), 0);
  const std::vector<std::int32_t> before = std::exchange(two_sided_, {});
  // Next to the surface of the lower liquid its side is neither wet nor dry.
  for (const auto& [one, other] : opposites_) {
    const auto is_open_to = [&](std::int32_t small) { return is_dry_[static_cast<std::size_t>(small)] == 0; };
    if ((!is_wet(one) || !is_open_to(other)) && (!is_wet(other) || !is_open_to(one))) continue;
    is_two_sided[static_cast<std::size_t>(one) / per_block] = 1;
    two_sided_.push_back(one);
  }
  may_hide_ = blocks_near(is_two_sided, reach());
  std::vector<std::uint8_t> changed = has_changed_;
  std::vector<std::int32_t> changes;
  std::set_symmetric_difference(before.begin(), before.end(), two_sided_.begin(), two_sided_.end(),
                                std::back_inserter(changes));
  for (const std::int32_t small : changes) changed[static_cast<std::size_t>(small) / per_block] = 1;
  has_new_view_ = blocks_near(changed, half_a_view);
  return !changes.empty();
}

template <int Dim>
bool ThinWalls<Dim>::has_new_view_at(const Vec<Dim>& x) const {
  const std::int32_t small = small_at(x);
  return small != none && has_new_view_[static_cast<std::size_t>(small) / per_block] != 0;
}

template <int Dim>
bool ThinWalls<Dim>::may_hide_at(const Vec<Dim>& x) const {
  const std::int32_t small = small_at(x);
  if (small == none || may_hide_[static_cast<std::size_t>(small) / per_block] == 0) return false;
  // By small cells: a point of the grid lies at the rim of its block, and in the mirror in another one.
  const int within = (2 * thin_ + 1) * fineness / 2;
  const Index<Dim> middle = place_of(small);
  Index<Dim> low;
  Index<Dim> sides;
  for (std::size_t d = 0; d < Dim; ++d) {
    low[d] = std::max(0, middle[d] - within) / fineness;
    sides[d] = std::min(blocks_[d], (middle[d] + within) / fineness + 1) - low[d];
  }
  const auto is_near = [&](std::int32_t other) {
    const Index<Dim> place = place_of(other);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (std::abs(place[d] - middle[d]) > within) return false;
    }
    return true;
  };
  for (std::size_t k = 0; k < rows_in<Dim>(sides); ++k) {
    Index<Dim> block = index_in<Dim>(sides, k);
    for (std::size_t d = 0; d < Dim; ++d) block[d] += low[d];
    const std::int32_t first = first_[row_in<Dim>(blocks_, block)];
    if (first == none) continue;
    const auto begin = std::lower_bound(two_sided_.begin(), two_sided_.end(), first);
    const auto end = std::lower_bound(begin, two_sided_.end(), first + static_cast<std::int32_t>(per_block));
    if (std::any_of(begin, end, is_near)) return true;
  }
  return false;
}

template <int Dim>
std::optional<std::int32_t> ThinWalls<Dim>::small_cell_of(const Shape<Dim>& shape, const Vec<Dim>& x) const {
  if (small_at(x) == none) return {};
  const std::int32_t small = telling(shape, x, shape.distance(x));
  return small == none ? std::nullopt : std::optional(small);
}

template <int Dim>
bool ThinWalls<Dim>::hides(const View& view, std::int32_t small) const {
  if (view.hides_all) return true;
  if (view.hidden.empty()) return false;
  const Index<Dim> place = place_of(small);
  std::size_t at = 0;
  for (std::size_t d = Dim; d-- > 0;) {
    const int along = place[d] - view.low[d];
    if (along < 0 || along >= view_across) return false;
    at = at * view_across + static_cast<std::size_t>(along);
  }
  return view.hidden[at] != 0;
}

template <int Dim>
double ThinWalls<Dim>::shaded(const Shape<Dim>& shape, const Vec<Dim>& x, double distance, const View* view) const {
  if (small_at(x) == none) return distance;
  const std::int32_t small = telling(shape, x, distance);
  if (small == none) return distance;
  const bool is_hidden = view != nullptr && hides(*view, small);
  if (!is_hidden && is_dry_[static_cast<std::size_t>(small)] == 0) return distance;
  return -distance - static_cast<double>(thickness_[static_cast<std::size_t>(small)]);
}

template <int Dim>
std::optional<typename ThinWalls<Dim>::Place> ThinWalls<Dim>::wet_on_both_sides(const Shape<Dim>& shape,
                                                                                double thinner_than) const {
  for (const auto& [one, other] : opposites_) {
    if (!is_wet(one) || !is_wet(other)) continue;
    const auto small = static_cast<std::size_t>(one);
    const Vec<Dim> x = middle_of_small(small);
    const auto thickness = static_cast<double>(thickness_[small]);
    if (thickness >= thinner_than) continue;
    const Vec<Dim> n = shape.gradient(x).stableNormalized();
    return Place{x - (shape.distance(x) + 0.5 * thickness) * n, thickness};
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

template <int Dim>
std::vector<std::int32_t> ThinWalls<Dim>::small_cells_from(const Index<Dim>& low) const {
  // Along every axis, what a place adds to the number of its block and to that within it.
  struct Part {
    std::size_t block;
    std::size_t within;
    bool is_in;
  };
  std::array<std::array<Part, view_across>, static_cast<std::size_t>(Dim)> part;
  std::size_t blocks_before = 1;
  std::size_t within_before = 1;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (int k = 0; k < view_across; ++k) {
      const int at = low[d] + k;
      const bool is_in = at >= 0 && at < blocks_[d] * fineness;
      const auto place = static_cast<std::size_t>(is_in ? at : 0);
      part[d][static_cast<std::size_t>(k)] = {place / fineness * blocks_before, place % fineness * within_before,
                                              is_in};
    }
    blocks_before *= static_cast<std::size_t>(blocks_[d]);
    within_before *= fineness;
  }
  std::vector<std::int32_t> small(power(view_across, Dim), none);
  Index<Dim> at{};
  for (std::int32_t& of : small) {
    Part sum{0, 0, true};
    for (std::size_t d = 0; d < Dim; ++d) {
      const Part& along = part[d][static_cast<std::size_t>(at[d])];
      sum = {sum.block + along.block, sum.within + along.within, sum.is_in && along.is_in};
    }
    if (sum.is_in && first_[sum.block] != none) of = first_[sum.block] + static_cast<std::int32_t>(sum.within);
    for (std::size_t d = 0; d < Dim && ++at[d] == view_across; ++d) at[d] = 0;
  }
  return small;
}

template <int Dim>
std::vector<std::int16_t> ThinWalls<Dim>::steps_around(const std::vector<std::int32_t>& small,
                                                       const std::vector<std::size_t>& starts) const {
  // Ways end at the rim of the window.
  static const std::vector<std::uint8_t> is_rim = [] {
    Index<Dim> across;
    across.fill(view_across);
    std::vector<std::uint8_t> rim(power(view_across, Dim));
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Index<Dim> at = index_in<Dim>(across, k);
      rim[k] = std::any_of(at.begin(), at.end(), [](int along) { return along == 0 || along == view_across - 1; });
    }
    return rim;
  }();
  std::vector<std::int16_t> around(small.size(), -1);
  std::vector<std::uint32_t> front;
  front.reserve(small.size());
  for (const std::size_t start : starts) {
    front.push_back(static_cast<std::uint32_t>(start));
    around[start] = 0;
  }
  for (std::size_t next = 0; next < front.size(); ++next) {
    const std::size_t k = front[next];
    if (is_rim[k] != 0) continue;
    const unsigned open = flags_[static_cast<std::size_t>(small[k])];
    for (std::size_t side = 0, step = 1; side < 2 * Dim; ++side) {
      const std::size_t other = side % 2 == 0 ? k - step : k + step;
      if ((open >> side & 1U) != 0 && around[other] < 0 && small[other] != none) {
        around[other] = static_cast<std::int16_t>(around[k] + 1);
        front.push_back(static_cast<std::uint32_t>(other));
      }
      if (side % 2 == 1) step *= static_cast<std::size_t>(view_across);
    }
  }
  return around;
}

template <int Dim>
std::vector<std::uint8_t> ThinWalls<Dim>::hidden_from(const std::vector<std::int32_t>& small,
                                                      const std::vector<std::size_t>& starts) const {
  Index<Dim> across;
  across.fill(view_across);
  std::vector<Index<Dim>> from;
  for (const std::size_t start : starts) from.push_back(index_in<Dim>(across, start));
  const std::vector<std::int16_t> around = steps_around(small, starts);
  constexpr int longer = static_cast<int>(detour * fineness);
  std::vector<std::uint8_t> hidden(small.size(), 0);
  Index<Dim> at{};
  for (std::size_t k = 0; k < small.size(); ++k) {
    if (may_be_wet(small[k])) {
      int through = std::numeric_limits<int>::max() - longer;
      for (const Index<Dim>& start : from) {
        int steps = 0;
        for (std::size_t d = 0; d < Dim; ++d) steps += std::abs(at[d] - start[d]);
        through = std::min(through, steps);
      }
      hidden[k] = around[k] < 0 || around[k] > through + longer ? 1 : 0;
    }
    for (std::size_t d = 0; d < Dim && ++at[d] == view_across; ++d) at[d] = 0;
  }
  return hidden;
}

template <int Dim>
std::optional<typename ThinWalls<Dim>::View>
ThinWalls<Dim>::view_from(const Shape<Dim>& shape, const Vec<Dim>& x,
                          const std::function<bool(const Vec<Dim>&)>& has_place) const {
  const auto middle = place_of(x);
  if (!middle) return {};
  View view;
  for (std::size_t d = 0; d < Dim; ++d) view.low[d] = (*middle)[d] - view_across / 2;
  Index<Dim> across;
  across.fill(view_across);
  std::vector<std::int32_t> small = small_cells_from(view.low);
  for (std::int32_t& of : small) {
    if (has_place && of != none && !has_place(middle_of_small(static_cast<std::size_t>(of)))) of = none;
  }
  std::vector<std::size_t> nearest;
  double least = spacing_ * spacing_;
  const double alike = 1e-6 * spacing_ * spacing_;
  // Those of them that are nearest to the place.
  Index<Dim> around_middle;
  around_middle.fill(2 * fineness + 1);
  for (std::size_t n = 0; n < rows_in<Dim>(around_middle); ++n) {
    Index<Dim> at = index_in<Dim>(around_middle, n);
    for (std::size_t d = 0; d < Dim; ++d) at[d] += view_across / 2 - fineness;
    const std::size_t k = row_in<Dim>(across, at);
    if (!may_be_wet(small[k])) continue;
    const double square = (middle_of_small(static_cast<std::size_t>(small[k])) - x).squaredNorm();
    if (square > least + alike) continue;
    if (square < least - alike) nearest.clear();
    least = std::min(least, square);
    nearest.push_back(k);
  }
  if (nearest.empty()) return {};
  // Of those that are equally near the ones that are farthest from the body: a lattice knows of no sides.
  const auto distance_of = [&](std::size_t k) {
    return shape.distance(middle_of_small(static_cast<std::size_t>(small[k])));
  };
  double farthest = 0;
  for (const std::size_t k : nearest) farthest = std::max(farthest, distance_of(k));
  std::erase_if(nearest, [&](std::size_t k) { return distance_of(k) < farthest - 1e-6 * spacing_; });
  std::vector<std::uint8_t> hidden = hidden_from(small, {nearest.front()});
  view.hides_all = std::any_of(nearest.begin(), nearest.end(), [&](std::size_t k) { return hidden[k] != 0; });
  if (nearest.size() > 1 && !view.hides_all) hidden = hidden_from(small, nearest);
  for (const std::size_t k : nearest) view.from.push_back(small[k]);
  if (std::any_of(hidden.begin(), hidden.end(), [](std::uint8_t is) { return is != 0; }))
    view.hidden = std::move(hidden);
  return view;
}

template class ThinWalls<2>;
template class ThinWalls<3>;

}  // namespace minamo
