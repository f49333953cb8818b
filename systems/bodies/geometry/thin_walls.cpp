#include "systems/bodies/geometry/thin_walls.hpp"

#include "systems/ranks/gathered.hpp"

#include <iterator>
#include <utility>

namespace minamo {

template <int Dim>
ThinWalls<Dim>::ThinWalls(WallCells<Dim> walls) : walls_(std::move(walls)) {
  const std::size_t count = walls_.cells().size();
  is_lit_.assign(count, 0);
  was_lit_.assign(count, 0);
  is_dry_.assign(count, 0);
  around_.assign(count, -1);
  has_changed_.assign(walls_.cells().kept(), 0);
  may_hide_.assign(walls_.cells().kept(), 0);
  has_new_view_.assign(walls_.cells().kept(), 0);
  has_new_places_.assign(walls_.cells().kept(), 0);
}

template <int Dim>
std::optional<ThinWalls<Dim>> ThinWalls<Dim>::find(const Shape<Dim>& shape, const Bounds<Dim>& region, double spacing,
                                                   int thin) {
  auto walls = WallCells<Dim>::find(shape, region, spacing, thin);
  return walls ? std::optional(ThinWalls(std::move(*walls))) : std::nullopt;
}

template <int Dim>
void ThinWalls<Dim>::light(const Shape<Dim>& shape, const Vec<Dim>& x) {
  if (walls_.cells().at(x) == none) return;
  const double distance = shape.distance(x);
  if (distance < 0) return;
  const std::int32_t small = walls_.telling(shape, x, distance);
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
  steps.assign(walls_.cells().size(), -1);
  std::vector<std::int32_t> front;
  for (std::size_t s = 0; s < walls_.cells().size(); ++s) {
    if (was_lit_[s] == 0) continue;
    steps[s] = 0;
    front.push_back(static_cast<std::int32_t>(s));
  }
  std::vector<std::int32_t> next;
  for (int step = 1; step <= most && !front.empty(); ++step) {
    next.clear();
    for (const std::int32_t s : front) {
      for (std::size_t side = 0; side < 2 * Dim; ++side) {
        if (!through_walls && !walls_.is_open_to(static_cast<std::size_t>(s), side)) continue;
        const std::int32_t other = walls_.cells().neighbour(static_cast<std::size_t>(s), side);
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
  constexpr int longer = static_cast<int>(WallCells<Dim>::detour * fineness);
  const int most = Dim * walls_.reach() * fineness;
  spread(true, most, through_);
  spread(false, most + longer, around_);
  bool any = false;
  for (std::size_t k = 0; k < walls_.cells().kept(); ++k) {
    has_changed_[k] = 0;
    for (std::size_t s = k * per_block; s < (k + 1) * per_block; ++s) {
      const bool is_behind = around_[s] < 0 || around_[s] > through_[s] + longer;
      const std::uint8_t is_dry = walls_.is_open(s) && through_[s] >= 0 && is_behind ? 1 : 0;
      if (is_dry != is_dry_[s]) has_changed_[k] = 1;
      is_dry_[s] = is_dry;
    }
    any = any || has_changed_[k] != 0;
  }
  return find_two_sided() || any;
}

template <int Dim>
bool ThinWalls<Dim>::find_two_sided() {
  std::vector<std::uint8_t> is_two_sided(walls_.cells().kept(), 0);
  const std::vector<std::int32_t> before = std::exchange(two_sided_, {});
  // Next to the surface of the lower liquid its side is neither wet nor dry.
  for (const auto& [one, other] : walls_.opposites()) {
    const auto is_open_to = [&](std::int32_t small) { return is_dry_[static_cast<std::size_t>(small)] == 0; };
    if ((!is_wet(one) || !is_open_to(other)) && (!is_wet(other) || !is_open_to(one))) continue;
    is_two_sided[static_cast<std::size_t>(one) / per_block] = 1;
    two_sided_.push_back(one);
  }
  may_hide_ = walls_.cells().blocks_near(is_two_sided, walls_.reach());
  std::vector<std::uint8_t> changed = has_changed_;
  std::vector<std::int32_t> changes;
  std::set_symmetric_difference(before.begin(), before.end(), two_sided_.begin(), two_sided_.end(),
                                std::back_inserter(changes));
  for (const std::int32_t small : changes) changed[static_cast<std::size_t>(small) / per_block] = 1;
  has_new_view_ = walls_.cells().blocks_near(changed, View::half);
  return !changes.empty();
}

template <int Dim>
bool ThinWalls<Dim>::has_new_view_at(const Vec<Dim>& x) const {
  const std::int32_t small = walls_.cells().at(x);
  return small != none && has_new_view_[static_cast<std::size_t>(small) / per_block] != 0;
}

template <int Dim>
bool ThinWalls<Dim>::may_hide_at(const Vec<Dim>& x) const {
  const std::int32_t small = walls_.cells().at(x);
  if (small == none || may_hide_[static_cast<std::size_t>(small) / per_block] == 0) return false;
  // By small cells: a point of the grid lies at the rim of its block, and in the mirror in another one.
  const int within = (2 * walls_.thin() + 1) * fineness / 2;
  const Index<Dim> middle = walls_.cells().place_of(small);
  const auto is_near = [&](std::int32_t other) {
    const Index<Dim> place = walls_.cells().place_of(other);
    for (std::size_t d = 0; d < Dim; ++d) {
      if (std::abs(place[d] - middle[d]) > within) return false;
    }
    return true;
  };
  const auto [low, high] = walls_.cells().blocks_around(middle, within);
  return walls_.cells().any_block(low, high, [&](std::int32_t first) {
    const auto begin = std::lower_bound(two_sided_.begin(), two_sided_.end(), first);
    const auto end = std::lower_bound(begin, two_sided_.end(), first + static_cast<std::int32_t>(per_block));
    return std::any_of(begin, end, is_near);
  });
}

template <int Dim>
std::optional<std::int32_t> ThinWalls<Dim>::small_cell_of(const Shape<Dim>& shape, const Vec<Dim>& x) const {
  if (walls_.cells().at(x) == none) return {};
  const std::int32_t small = walls_.telling(shape, x, shape.distance(x));
  return small == none ? std::nullopt : std::optional(small);
}

template <int Dim>
double ThinWalls<Dim>::shaded(const Shape<Dim>& shape, const Vec<Dim>& x, double distance, const View* view) const {
  if (walls_.cells().at(x) == none) return distance;
  const std::int32_t small = walls_.telling(shape, x, distance);
  if (small == none) return distance;
  const bool is_hidden = view != nullptr && hides(*view, small);
  if (!is_hidden && is_dry_[static_cast<std::size_t>(small)] == 0) return distance;
  return -distance - walls_.thickness(static_cast<std::size_t>(small));
}

template <int Dim>
std::optional<typename ThinWalls<Dim>::Place> ThinWalls<Dim>::wet_on_both_sides(const Shape<Dim>& shape,
                                                                                double thinner_than) const {
  for (const auto& [one, other] : walls_.opposites()) {
    if (!is_wet(one) || !is_wet(other)) continue;
    const auto small = static_cast<std::size_t>(one);
    const Vec<Dim> x = walls_.cells().middle(small);
    const auto thickness = walls_.thickness(small);
    if (thickness >= thinner_than) continue;
    const Vec<Dim> n = shape.gradient(x).stableNormalized();
    return Place{x - (shape.distance(x) + 0.5 * thickness) * n, thickness};
  }
  return {};
}

template <int Dim>
bool ThinWalls<Dim>::has_changed_near(const Vec<Dim>& x, double within) const {
  const auto [low, high] = walls_.cells().blocks_around(x, within);
  return walls_.cells().any_block(
      low, high, [&](std::int32_t first) { return has_changed_[static_cast<std::size_t>(first) / per_block] != 0; });
}

template class ThinWalls<2>;
template class ThinWalls<3>;

}  // namespace minamo
