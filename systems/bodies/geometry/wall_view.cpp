#include "systems/bodies/geometry/wall_view.hpp"

#include <algorithm>

namespace minamo {

namespace {

template <int Dim>
bool may_be_wet(const WallCells<Dim>& walls, std::span<const std::uint8_t> is_dry, std::int32_t small) {
  return small != WallCells<Dim>::none && walls.is_open(static_cast<std::size_t>(small)) &&
         is_dry[static_cast<std::size_t>(small)] == 0;
}

template <int Dim>
Index<Dim> window_of(int across) {
  Index<Dim> window;
  window.fill(across);
  return window;
}

/// The small cells of a window, none where there is no grid.
template <int Dim>
std::vector<std::int32_t> window_at(const SmallCells<Dim>& cells, const WallLight& light, const Index<Dim>& low,
                                    int across) {
  std::vector<std::int32_t> small = cells.window(low, across);
  if (light.has_place.empty()) return small;
  for (std::int32_t& of : small) {
    if (of != WallCells<Dim>::none && light.has_place[static_cast<std::size_t>(of)] == 0) of = WallCells<Dim>::none;
  }
  return small;
}

/// The small cells that may be wet, up to a cell of the grid away, that are nearest to a point. Of those that are
/// equally near the ones that are farthest from the body: a lattice knows of no sides.
/// \param middle  the point's place
template <int Dim>
std::vector<std::int32_t> nearest_wet(const WallCells<Dim>& walls, const WallLight& light, const Shape<Dim>& shape,
                                      const Vec<Dim>& x, const Index<Dim>& middle) {
  const SmallCells<Dim>& cells = walls.cells();
  const double spacing = cells.spacing();
  const double alike = 1e-6 * spacing * spacing;
  Index<Dim> low = middle;
  for (int& along : low) along -= SmallCells<Dim>::fineness;
  std::vector<std::int32_t> nearest;
  double least = spacing * spacing;
  for (const std::int32_t small : window_at<Dim>(cells, light, low, 2 * SmallCells<Dim>::fineness + 1)) {
    if (!may_be_wet<Dim>(walls, light.is_dry, small)) continue;
    const double square = (cells.middle(static_cast<std::size_t>(small)) - x).squaredNorm();
    if (square > least + alike) continue;
    if (square < least - alike) nearest.clear();
    least = std::min(least, square);
    nearest.push_back(small);
  }
  std::vector<double> distance;
  double farthest = 0;
  for (const std::int32_t small : nearest) {
    distance.push_back(shape.distance(cells.middle(static_cast<std::size_t>(small))));
    farthest = std::max(farthest, distance.back());
  }
  std::size_t n = 0;
  std::erase_if(nearest, [&](std::int32_t) { return distance[n++] < farthest - 1e-6 * spacing; });
  return nearest;
}

/// Steps from some of the small cells of a window to the others around walls, or -1.
template <int Dim>
std::vector<std::int16_t> steps_around(const WallCells<Dim>& walls, const std::vector<std::int32_t>& small,
                                       const std::vector<std::size_t>& starts) {
  // Ways end at the rim of the window.
  static const std::vector<std::uint8_t> is_rim = [] {
    const auto across = window_of<Dim>(WallView<Dim>::across);
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

/// What of a window walls hide from some of its small cells. It does not ask what is dry: that counts as the body's
/// in any case.
template <int Dim>
class Hiding {
 public:
  Hiding(const WallCells<Dim>& walls, const std::vector<std::int32_t>& small, const std::vector<std::size_t>& starts)
      : walls_(walls), small_(small), around_(steps_around<Dim>(walls, small, starts)) {
    for (const std::size_t start : starts) from_.push_back(place_of(start));
    for (const Index<Dim>& start : from_) spread_ = std::max(spread_, steps_between(start, from_.front()));
  }

  bool hides(std::size_t k) const { return hides(k, place_of(k)); }
  /// Of all small cells of the window, 1 or 0; empty: none is hidden.
  std::vector<std::uint8_t> all() const {
    std::vector<std::uint8_t> hidden(small_.size(), 0);
    bool any = false;
    Index<Dim> at{};
    for (std::size_t k = 0; k < small_.size(); ++k) {
      hidden[k] = hides(k, at) ? 1 : 0;
      any = any || hidden[k] != 0;
      for (std::size_t d = 0; d < Dim && ++at[d] == WallView<Dim>::across; ++d) at[d] = 0;
    }
    return any ? hidden : std::vector<std::uint8_t>();
  }

 private:
  static constexpr int longer = static_cast<int>(WallCells<Dim>::detour * SmallCells<Dim>::fineness);

  static Index<Dim> place_of(std::size_t k) { return index_in<Dim>(window_of<Dim>(WallView<Dim>::across), k); }
  static int steps_between(const Index<Dim>& one, const Index<Dim>& other) {
    int steps = 0;
    for (std::size_t d = 0; d < Dim; ++d) steps += std::abs(one[d] - other[d]);
    return steps;
  }
  bool hides(std::size_t k, const Index<Dim>& at) const {
    const int around = around_[k];
    int through = steps_between(at, from_.front());
    if (around >= 0 && around <= through - spread_ + longer) return false;  // whichever start is the nearest
    if (small_[k] == WallCells<Dim>::none || !walls_.is_open(static_cast<std::size_t>(small_[k]))) return false;
    if (around < 0) return true;
    for (const Index<Dim>& start : from_) through = std::min(through, steps_between(at, start));
    return around > through + longer;
  }

  const WallCells<Dim>& walls_;
  const std::vector<std::int32_t>& small_;
  std::vector<std::int16_t> around_;
  std::vector<Index<Dim>> from_;
  int spread_ = 0;  ///< steps from the first start to the others at most
};

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
std::optional<WallView<Dim>> view_from(const WallCells<Dim>& walls, const WallLight& light, const Shape<Dim>& shape,
                                       const Vec<Dim>& x, WallView<Dim>* former) {
  const SmallCells<Dim>& cells = walls.cells();
  const auto middle = cells.place_of(x);
  if (!middle) return {};
  const std::vector<std::int32_t> nearest = nearest_wet<Dim>(walls, light, shape, x, *middle);
  if (nearest.empty()) return {};
  WallView<Dim> view;
  for (std::size_t d = 0; d < Dim; ++d) view.low[d] = (*middle)[d] - WallView<Dim>::across / 2;
  if (former != nullptr && former->low == view.low && former->from == nearest) return std::move(*former);
  view.from = nearest;
  std::vector<std::size_t> starts;
  for (const std::int32_t small : nearest) {
    Index<Dim> at = cells.place_of(small);
    for (std::size_t d = 0; d < Dim; ++d) at[d] -= view.low[d];
    starts.push_back(row_in<Dim>(window_of<Dim>(WallView<Dim>::across), at));
  }
  const std::vector<std::int32_t> small = window_at<Dim>(cells, light, view.low, WallView<Dim>::across);
  const Hiding<Dim> of_first(walls, small, {starts.front()});
  view.hides_all = std::any_of(starts.begin(), starts.end(), [&](std::size_t k) { return of_first.hides(k); });
  view.hidden = starts.size() == 1 || view.hides_all ? of_first.all() : Hiding<Dim>(walls, small, starts).all();
  return view;
}

template struct WallView<2>;
template struct WallView<3>;
template std::optional<WallView<2>> view_from<2>(const WallCells<2>&, const WallLight&, const Shape<2>&, const Vec<2>&,
                                                 WallView<2>*);
template std::optional<WallView<3>> view_from<3>(const WallCells<3>&, const WallLight&, const Shape<3>&, const Vec<3>&,
                                                 WallView<3>*);

}  // namespace minamo
