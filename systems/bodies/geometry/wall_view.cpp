#include "systems/bodies/geometry/wall_view.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace minamo {

namespace {

template <int Dim>
bool may_be_wet(const WallCells<Dim>& walls, std::span<const std::uint8_t> is_dry, std::int32_t small) {
  return small != WallCells<Dim>::none && walls.is_open(static_cast<std::size_t>(small)) &&
         is_dry[static_cast<std::size_t>(small)] == 0;
}

/// Steps from some of the small cells of a window to the others around walls, or -1.
template <int Dim>
std::vector<std::int16_t> steps_around(const WallCells<Dim>& walls, const std::vector<std::int32_t>& small,
                                       const std::vector<std::size_t>& starts) {
  // Ways end at the rim of the window.
  static const std::vector<std::uint8_t> is_rim = [] {
    Index<Dim> across;
    across.fill(WallView<Dim>::across);
    std::vector<std::uint8_t> rim(power(WallView<Dim>::across, Dim));
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Index<Dim> at = index_in<Dim>(across, k);
      rim[k] =
          std::any_of(at.begin(), at.end(), [](int along) { return along == 0 || along == WallView<Dim>::across - 1; });
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
    const unsigned open = walls.open_sides(static_cast<std::size_t>(small[k]));
    for (std::size_t side = 0, step = 1; side < 2 * Dim; ++side) {
      const std::size_t other = side % 2 == 0 ? k - step : k + step;
      if ((open >> side & 1U) != 0 && around[other] < 0 && small[other] != WallCells<Dim>::none) {
        around[other] = static_cast<std::int16_t>(around[k] + 1);
        front.push_back(static_cast<std::uint32_t>(other));
      }
      if (side % 2 == 1) step *= static_cast<std::size_t>(WallView<Dim>::across);
    }
  }
  return around;
}

/// What of a window walls hide from some of its small cells, 1 or 0.
template <int Dim>
std::vector<std::uint8_t> hidden_from(const WallCells<Dim>& walls, std::span<const std::uint8_t> is_dry,
                                      const std::vector<std::int32_t>& small, const std::vector<std::size_t>& starts) {
  Index<Dim> across;
  across.fill(WallView<Dim>::across);
  std::vector<Index<Dim>> from;
  for (const std::size_t start : starts) from.push_back(index_in<Dim>(across, start));
  const std::vector<std::int16_t> around = steps_around<Dim>(walls, small, starts);
  constexpr int longer = static_cast<int>(WallCells<Dim>::detour * SmallCells<Dim>::fineness);
  std::vector<std::uint8_t> hidden(small.size(), 0);
  Index<Dim> at{};
  for (std::size_t k = 0; k < small.size(); ++k) {
    if (may_be_wet<Dim>(walls, is_dry, small[k])) {
      int through = std::numeric_limits<int>::max() - longer;
      for (const Index<Dim>& start : from) {
        int steps = 0;
        for (std::size_t d = 0; d < Dim; ++d) steps += std::abs(at[d] - start[d]);
        through = std::min(through, steps);
      }
      hidden[k] = around[k] < 0 || around[k] > through + longer ? 1 : 0;
    }
    for (std::size_t d = 0; d < Dim && ++at[d] == WallView<Dim>::across; ++d) at[d] = 0;
  }
  return hidden;
}

}  // namespace

template <int Dim>
bool WallView<Dim>::hides(const SmallCells<Dim>& cells, std::int32_t small) const {
  if (hides_all) return true;
  if (hidden.empty()) return false;
  const Index<Dim> place = cells.place_of(small);
  std::size_t at = 0;
  for (std::size_t d = Dim; d-- > 0;) {
    const int along = place[d] - low[d];
    if (along < 0 || along >= across) return false;
    at = at * across + static_cast<std::size_t>(along);
  }
  return hidden[at] != 0;
}

template <int Dim>
std::optional<WallView<Dim>> view_from(const WallCells<Dim>& walls, std::span<const std::uint8_t> is_dry,
                                       const Shape<Dim>& shape, const Vec<Dim>& x,
                                       const std::function<bool(const Vec<Dim>&)>& has_place) {
  constexpr std::int32_t none = WallCells<Dim>::none;
  constexpr int fineness = SmallCells<Dim>::fineness;
  const SmallCells<Dim>& cells = walls.cells();
  const double spacing = cells.spacing();
  const auto middle = cells.place_of(x);
  if (!middle) return {};
  WallView<Dim> view;
  for (std::size_t d = 0; d < Dim; ++d) view.low[d] = (*middle)[d] - WallView<Dim>::across / 2;
  Index<Dim> across;
  across.fill(WallView<Dim>::across);
  std::vector<std::int32_t> small = cells.window(view.low, WallView<Dim>::across);
  for (std::int32_t& of : small) {
    if (has_place && of != none && !has_place(cells.middle(static_cast<std::size_t>(of)))) of = none;
  }
  std::vector<std::size_t> nearest;
  double least = spacing * spacing;
  const double alike = 1e-6 * spacing * spacing;
  // Those of them that are nearest to the place.
  Index<Dim> around_middle;
  around_middle.fill(2 * fineness + 1);
  for (std::size_t n = 0; n < rows_in<Dim>(around_middle); ++n) {
    Index<Dim> at = index_in<Dim>(around_middle, n);
    for (std::size_t d = 0; d < Dim; ++d) at[d] += WallView<Dim>::across / 2 - fineness;
    const std::size_t k = row_in<Dim>(across, at);
    if (!may_be_wet<Dim>(walls, is_dry, small[k])) continue;
    const double square = (cells.middle(static_cast<std::size_t>(small[k])) - x).squaredNorm();
    if (square > least + alike) continue;
    if (square < least - alike) nearest.clear();
    least = std::min(least, square);
    nearest.push_back(k);
  }
  if (nearest.empty()) return {};
  // Of those that are equally near the ones that are farthest from the body: a lattice knows of no sides.
  const auto distance_of = [&](std::size_t k) {
    return shape.distance(cells.middle(static_cast<std::size_t>(small[k])));
  };
  double farthest = 0;
  for (const std::size_t k : nearest) farthest = std::max(farthest, distance_of(k));
  std::erase_if(nearest, [&](std::size_t k) { return distance_of(k) < farthest - 1e-6 * spacing; });
  std::vector<std::uint8_t> hidden = hidden_from<Dim>(walls, is_dry, small, {nearest.front()});
  view.hides_all = std::any_of(nearest.begin(), nearest.end(), [&](std::size_t k) { return hidden[k] != 0; });
  if (nearest.size() > 1 && !view.hides_all) hidden = hidden_from<Dim>(walls, is_dry, small, nearest);
  for (const std::size_t k : nearest) view.from.push_back(small[k]);
  if (std::any_of(hidden.begin(), hidden.end(), [](std::uint8_t is) { return is != 0; }))
    view.hidden = std::move(hidden);
  return view;
}

template struct WallView<2>;
template struct WallView<3>;
template std::optional<WallView<2>> view_from<2>(const WallCells<2>&, std::span<const std::uint8_t>, const Shape<2>&,
                                                 const Vec<2>&, const std::function<bool(const Vec<2>&)>&);
template std::optional<WallView<3>> view_from<3>(const WallCells<3>&, std::span<const std::uint8_t>, const Shape<3>&,
                                                 const Vec<3>&, const std::function<bool(const Vec<3>&)>&);

}  // namespace minamo
