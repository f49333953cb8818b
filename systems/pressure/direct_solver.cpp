#include "systems/pressure/direct_solver.hpp"

#include <algorithm>
#include <numeric>

namespace minamo {

/// Coordinates from the lowest on. Where the liquid goes around, 0, last, 1, last - 1, ...: else the last plane is
/// coupled to the first one, across the whole matrix.
template <int Dim>
void EnvelopeOrder<Dim>::find_coordinates(const StaggeredLaplacian<Dim>& matrix) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d) {
    auto& [of_row, count] = coordinates_[d];
    of_row.resize(matrix.rows());
    int low = matrix.counts[d];
    bool goes_around = false;
    for (std::size_t l = 0; l < matrix.rows(); ++l) {
      const int coordinate = matrix.site[l][d];
      low = std::min(low, coordinate);
      goes_around = goes_around || (coordinate == 0 && matrix.neighbour[l][2 * d] >= 0);
    }
    std::uint32_t high = 0;
    for (std::size_t l = 0; l < matrix.rows(); ++l) {
      const int coordinate = matrix.site[l][d];
      const int from_end = matrix.counts[d] - 1 - coordinate;
      const int key = !goes_around ? coordinate - low : coordinate <= from_end ? 2 * coordinate : 2 * from_end + 1;
      of_row[l] = static_cast<std::uint32_t>(key);
      high = std::max(high, of_row[l]);
    }
    count = high + 1;
  }
}

/// Stable, so that what was sorted by before counts among equals.
template <int Dim>
void EnvelopeOrder<Dim>::sort_by(std::size_t axis) {
  const auto& [of_row, count] = coordinates_[axis];
  begin_.assign(count + 1, 0);
  for (const std::uint32_t coordinate : of_row) ++begin_[coordinate + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  sorted_.resize(order_.size());
  for (const std::uint32_t row : order_) sorted_[begin_[of_row[row]]++] = row;
  order_.swap(sorted_);
}

template <int Dim>
void EnvelopeOrder<Dim>::try_order(const StaggeredLaplacian<Dim>& matrix, const Axes& fastest_first) {
  order_.resize(matrix.rows());
  std::iota(order_.begin(), order_.end(), 0);
  for (const std::size_t axis : fastest_first) sort_by(axis);
  try_place_.resize(matrix.rows());
  try_first_.resize(matrix.rows());
  for (std::uint32_t i = 0; i < order_.size(); ++i) try_place_[order_[i]] = i;
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    std::uint32_t first = i;
    for (const std::int32_t m : matrix.neighbour[order_[i]]) {
      if (m >= 0) first = std::min(first, try_place_[static_cast<std::size_t>(m)]);
    }
    try_first_[i] = first;
  }
  const double work = envelope_work(try_first_);
  if (!first_.empty() && work >= work_) return;
  work_ = work;
  place_.swap(try_place_);
  first_.swap(try_first_);
}

template <int Dim>
void EnvelopeOrder<Dim>::find(const StaggeredLaplacian<Dim>& matrix) {
  find_coordinates(matrix);
  first_.clear();
  Axes axes;
  std::iota(axes.begin(), axes.end(), std::size_t{0});
  do {
    try_order(matrix, axes);
  } while (std::next_permutation(axes.begin(), axes.end()));
}

template <int Dim>
double DirectSolver<Dim>::analyse(const StaggeredLaplacian<Dim>& matrix) {
  order_.find(matrix);
  return order_.work();
}

template <int Dim>
bool DirectSolver<Dim>::factorize(const StaggeredLaplacian<Dim>& matrix, std::span<const std::uint32_t> grounded) {
  factors_.start(order_.first());
  const auto place = order_.place();
  for (std::size_t l = 0; l < matrix.rows(); ++l) {
    factors_.at(place[l], place[l]) = matrix.diagonal[l];
    for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d) {
      const std::int32_t high = matrix.neighbour[l][2 * d + 1];
      if (high < 0) continue;
      const auto [lower, upper] = std::minmax(place[l], place[static_cast<std::size_t>(high)]);
      factors_.at(upper, lower) -= matrix.conductance[l][d];  // twice where an axis has two sites and goes around
    }
  }
  for (const std::uint32_t l : grounded) factors_.at(place[l], place[l]) *= 2;
  x_.assign(factors_.padded_rows(), EnvelopeCholesky::Row{});
  return factors_.factorize();
}

template <int Dim>
void DirectSolver<Dim>::solve(std::span<const Sources> b, std::span<Sources> x) {
  const auto place = order_.place();
  for (std::size_t l = 0; l < b.size(); ++l) x_[place[l]].lane = Four{b[l][0], b[l][1], b[l][2], 0};
  factors_.solve(x_);
  for (std::size_t l = 0; l < b.size(); ++l) {
    const Four x_l = x_[place[l]].lane;
    x[l] = {x_l[0], x_l[1], x_l[2]};
  }
}

template class EnvelopeOrder<2>;
template class EnvelopeOrder<3>;
template class DirectSolver<2>;
template class DirectSolver<3>;

}  // namespace minamo
