#include "systems/pressure/closed_components.hpp"

#include <cmath>

namespace minamo {

/// What a row may miss of S n = 0 in a closed component, as part of S_ll n_l: rounding of those who assemble S.
constexpr double closed_up_to = 1e-10;

std::uint32_t ClosedComponents::first_row(std::uint32_t row) {
  while (joined_to_[row] != row) row = joined_to_[row] = joined_to_[joined_to_[row]];
  return row;
}

template <int Dim>
void ClosedComponents::join_rows(const StaggeredLaplacian<Dim>& matrix) {
  joined_to_.resize(matrix.rows());
  for (std::uint32_t l = 0; l < joined_to_.size(); ++l) {
    joined_to_[l] = l;
    std::uint32_t first = l;
    matrix.for_each_neighbour(l, [&](std::size_t m, double conductance) {
      if (m >= l || conductance <= 0) return;
      const std::uint32_t other = first_row(static_cast<std::uint32_t>(m));
      joined_to_[std::max(first, other)] = std::min(first, other);
      first = std::min(first, other);
    });
  }
}

template <int Dim>
void ClosedComponents::find(const StaggeredLaplacian<Dim>& matrix, std::span<const double> n) {
  join_rows(matrix);
  is_open_.assign(matrix.rows(), 0);
  for (std::uint32_t l = 0; l < matrix.rows(); ++l) {
    const double own = matrix.diagonal[l] * n[l];
    double left = own;
    matrix.for_each_neighbour(l, [&](std::size_t m, double conductance) { left -= conductance * n[m]; });
    if (std::abs(left) > closed_up_to * own) is_open_[first_row(l)] = 1;
  }
  grounded_.clear();
  number_.resize(matrix.rows());
  for (std::uint32_t l = 0; l < matrix.rows(); ++l) {
    const std::uint32_t first = first_row(l);
    if (first == l && is_open_[l] == 0) grounded_.push_back(l);
    number_[l] = first != l ? number_[first] : is_open_[l] == 0 ? static_cast<std::uint32_t>(grounded_.size()) : 0;
  }
}

void ClosedComponents::remove_null_part(std::span<const double> n, std::span<Sources> b) const {
  if (count() == 0) return;
  sums_.assign(count(), Sums{});
  for (std::size_t l = 0; l < b.size(); ++l) {
    if (number_[l] == 0) continue;
    Sums& sums = sums_[number_[l] - 1];
    sums.square += n[l] * n[l];
    for (std::size_t s = 0; s < most_sources; ++s) sums.along[s] += n[l] * b[l][s];
  }
  for (std::size_t l = 0; l < b.size(); ++l) {
    if (number_[l] == 0) continue;
    const Sums& sums = sums_[number_[l] - 1];
    for (std::size_t s = 0; s < most_sources; ++s) b[l][s] -= n[l] * (sums.along[s] / sums.square);
  }
}

template void ClosedComponents::find<2>(const StaggeredLaplacian<2>&, std::span<const double>);
template void ClosedComponents::find<3>(const StaggeredLaplacian<3>&, std::span<const double>);

}  // namespace minamo
