#include "systems/bodies/geometry/small_cells.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
SmallCells<Dim>::SmallCells(const Bounds<Dim>& region, double spacing) : spacing_(spacing) {
  const double half = 0.5 * side();
  low_ = region.low - Vec<Dim>::Constant(half);
  for (int d = 0; d < Dim; ++d)
    blocks_[static_cast<std::size_t>(d)] = static_cast<int>(std::ceil((region.high[d] + half - low_[d]) / spacing));
}

template <int Dim>
void SmallCells<Dim>::keep(const std::vector<std::uint8_t>& marked, int within) {
  first_.assign(marked.size(), none);
  for (std::size_t block = 0; block < marked.size(); ++block) {
    if (marked[block] == 0) continue;
    const Index<Dim> at = index_in<Dim>(blocks_, block);
    Index<Dim> low;
    Index<Dim> sides;
    for (std::size_t d = 0; d < Dim; ++d) {
      low[d] = std::max(0, at[d] - within);
      sides[d] = std::min(blocks_[d], at[d] + within + 1) - low[d];
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
  next_.resize(kept_.size());
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      Index<Dim> at = index_in<Dim>(blocks_, kept_[k]);
      int& along = at[side / 2];
      along += side % 2 == 0 ? -1 : 1;
      next_[k][side] = along < 0 || along >= blocks_[side / 2] ? none : first_[row_in<Dim>(blocks_, at)];
    }
  }
}

template <int Dim>
Vec<Dim> SmallCells<Dim>::middle_of_block(std::size_t block) const {
  const Index<Dim> at = index_in<Dim>(blocks_, block);
  Vec<Dim> x = low_ + Vec<Dim>::Constant(0.5 * spacing_);
  for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] += spacing_ * at[d];
  return x;
}

template <int Dim>
Vec<Dim> SmallCells<Dim>::middle_within(std::size_t block, std::size_t within) const {
  Index<Dim> sides;
  sides.fill(fineness);
  const Index<Dim> at = index_in<Dim>(sides, within);
  const double size = side();
  Vec<Dim> x = middle_of_block(block) - Vec<Dim>::Constant(0.5 * (spacing_ - size));
  for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] += size * at[d];
  return x;
}

template <int Dim>
std::optional<Index<Dim>> SmallCells<Dim>::place_of(const Vec<Dim>& x) const {
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
Index<Dim> SmallCells<Dim>::place_of(std::int32_t small) const {
  const auto s = static_cast<std::size_t>(small);
  Index<Dim> sides;
  sides.fill(fineness);
  Index<Dim> place = index_in<Dim>(blocks_, kept_[s / per_block]);
  const Index<Dim> within = index_in<Dim>(sides, s % per_block);
  for (std::size_t d = 0; d < Dim; ++d) place[d] = place[d] * fineness + within[d];
  return place;
}

template <int Dim>
std::int32_t SmallCells<Dim>::at(const Index<Dim>& place) const {
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
std::int32_t SmallCells<Dim>::at(const Vec<Dim>& x) const {
  const auto place = place_of(x);
  return place ? at(*place) : none;
}

template <int Dim>
std::int32_t SmallCells<Dim>::neighbour(std::size_t small, std::size_t side) const {
  const std::size_t stride = power(fineness, static_cast<int>(side / 2));
  const std::size_t along = small % per_block / stride % fineness;
  const std::size_t last = fineness - 1;
  const auto s = static_cast<std::int32_t>(small);
  const auto step = static_cast<std::int32_t>(stride);
  if (side % 2 == 0 ? along > 0 : along < last) return side % 2 == 0 ? s - step : s + step;
  const std::int32_t block = next_[small / per_block][side];
  if (block == none) return none;
  const auto across = static_cast<std::int32_t>(last) * step;  // to the opposite end of a block
  return block + s % static_cast<std::int32_t>(per_block) + (side % 2 == 0 ? across : -across);
}

template <int Dim>
std::vector<std::uint8_t> SmallCells<Dim>::blocks_near(const std::vector<std::uint8_t>& marked, int within) const {
  std::vector<std::uint8_t> near(kept_.size(), 0);
  Index<Dim> window;
  window.fill(2 * within + 1);
  for (std::size_t kept = 0; kept < kept_.size(); ++kept) {
    if (marked[kept] == 0) continue;
    const Index<Dim> block = index_in<Dim>(blocks_, kept_[kept]);
    for (std::size_t k = 0; k < rows_in<Dim>(window); ++k) {
      Index<Dim> place = index_in<Dim>(window, k);
      for (std::size_t d = 0; d < Dim; ++d) place[d] = (place[d] + block[d] - within) * fineness;
      const std::int32_t small = at(place);
      if (small != none) near[static_cast<std::size_t>(small) / per_block] = 1;
    }
  }
  return near;
}

template <int Dim>
std::vector<std::int32_t> SmallCells<Dim>::window(const Index<Dim>& low, int across) const {
  // Along every axis, what a place adds to the number of its block and to that within it.
  struct Part {
    std::size_t block;
    std::size_t within;
    bool is_in;
  };
  std::array<std::vector<Part>, static_cast<std::size_t>(Dim)> part;
  std::size_t blocks_before = 1;
  std::size_t within_before = 1;
  for (std::size_t d = 0; d < Dim; ++d) {
    part[d].resize(static_cast<std::size_t>(across));
    for (int k = 0; k < across; ++k) {
      const int at = low[d] + k;
      const bool is_in = at >= 0 && at < blocks_[d] * fineness;
      const auto place = static_cast<std::size_t>(is_in ? at : 0);
      part[d][static_cast<std::size_t>(k)] = {place / fineness * blocks_before, place % fineness * within_before,
                                              is_in};
    }
    blocks_before *= static_cast<std::size_t>(blocks_[d]);
    within_before *= fineness;
  }
  std::vector<std::int32_t> small(power(static_cast<std::size_t>(across), Dim), none);
  Index<Dim> at{};
  for (std::int32_t& of : small) {
    Part sum{0, 0, true};
    for (std::size_t d = 0; d < Dim; ++d) {
      const Part& along = part[d][static_cast<std::size_t>(at[d])];
      sum = {sum.block + along.block, sum.within + along.within, sum.is_in && along.is_in};
    }
    if (sum.is_in && first_[sum.block] != none) of = first_[sum.block] + static_cast<std::int32_t>(sum.within);
    for (std::size_t d = 0; d < Dim && ++at[d] == across; ++d) at[d] = 0;
  }
  return small;
}

template <int Dim>
std::array<Index<Dim>, 2> SmallCells<Dim>::blocks_around(const Vec<Dim>& x, double within) const {
  std::array<Index<Dim>, 2> ends;
  for (std::size_t d = 0; d < Dim; ++d) {
    const double along = x[static_cast<Eigen::Index>(d)] - low_[static_cast<Eigen::Index>(d)];
    ends[0][d] = std::max(0, static_cast<int>(std::floor((along - within) / spacing_)));
    ends[1][d] = std::min(blocks_[d] - 1, static_cast<int>(std::floor((along + within) / spacing_)));
  }
  return ends;
}

template <int Dim>
std::array<Index<Dim>, 2> SmallCells<Dim>::blocks_around(const Index<Dim>& place, int within) const {
  std::array<Index<Dim>, 2> ends;
  for (std::size_t d = 0; d < Dim; ++d) {
    ends[0][d] = std::max(0, place[d] - within) / fineness;
    ends[1][d] = std::min(blocks_[d] - 1, (place[d] + within) / fineness);
  }
  return ends;
}

template class SmallCells<2>;
template class SmallCells<3>;

}  // namespace minamo
