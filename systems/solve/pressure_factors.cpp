#include "systems/solve/pressure_factors.hpp"

#include <algorithm>
#include <limits>

namespace minamo {

namespace {

/// Multiplications from which on an envelope is slower than incomplete factors.
constexpr double widest = 1e10;

}  // namespace

double laplacian_factor(const Coefficients& c, const Fluid& fluid, const matrix::StabilizationScale& scale) {
  const double of_velocity = c.c_v - c.c_a * scale.acceleration;
  return 1 + std::max(0.0, of_velocity) / (c.c_a * fluid.density * scale.pressure);
}

template <int Dim>
double viscous_part(const Coefficients& c, const Grid<Dim>& grid, const Fluid& fluid,
                    const matrix::StabilizationScale& scale) {
  const double of_velocity = c.c_v - c.c_a * scale.acceleration;
  if (of_velocity <= 0) return 0;
  const double k2 = 4 / (grid.spacing * grid.spacing);
  const double a = fluid.density * c.c_a / of_velocity;
  const double mu = c.c_v * fluid.viscosity / of_velocity;
  const double inverse = 1 / (1 / (a / k2 + mu) + scale.pressure * k2);
  const double of_compact = 1 / ((1 / a + scale.pressure) * k2);
  return fluid.density * std::max(0.0, inverse - of_compact);
}

/// The longest axis of the active nodes is the slowest, so that the envelope is narrow.
template <int Dim>
void PressureFactors<Dim>::find_order(std::span<const Index<Dim>> site, std::span<const std::uint32_t> node) {
  order_.resize(node.size());
  place_.resize(node.size());
  std::array<std::pair<int, std::size_t>, Dim> axes;
  for (std::size_t d = 0; d < axes.size(); ++d) {
    int low = std::numeric_limits<int>::max();
    int high = 0;
    for (const std::uint32_t i : node) {
      low = std::min(low, site[i][d]);
      high = std::max(high, site[i][d]);
    }
    axes[d] = {low - high, d};
  }
  std::sort(axes.begin(), axes.end());
  keys_.resize(order_.size());
  for_each_row(order_.size(), [&](std::size_t r) {
    auto& [key, row] = keys_[r];
    row = static_cast<std::uint32_t>(r);
    for (std::size_t d = 0; d < axes.size(); ++d) key[d] = site[node[r]][axes[d].second];
  });
  if (!std::is_sorted(keys_.begin(), keys_.end())) std::sort(keys_.begin(), keys_.end());
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    order_[i] = keys_[i].second;
    place_[order_[i]] = i;
  }
}

template <int Dim>
void PressureFactors<Dim>::find_envelope(const SparseRows& matrix) {
  first_.resize(order_.size());
  for (std::uint32_t i = 0; i < first_.size(); ++i) first_[i] = i;
  for (std::size_t r = 0; r < order_.size(); ++r) {
    const std::uint32_t own = place_[r];
    for (std::uint32_t e = matrix.begin[r]; e < matrix.begin[r + 1]; ++e) {
      // Some entries have none across from them.
      const auto [low, high] = std::minmax(own, place_[matrix.column[e]]);
      first_[high] = std::min(first_[high], low);
    }
  }
}

template <int Dim>
bool PressureFactors<Dim>::factorize_envelope(const SparseRows& matrix) {
  complete_.start(first_);
  for (std::size_t r = 0; r < order_.size(); ++r) {
    for (std::uint32_t e = matrix.begin[r]; e < matrix.begin[r + 1]; ++e) {
      complete_.at(place_[r], place_[matrix.column[e]]) += matrix.value[e];
    }
  }
  return complete_.factorize();
}

template <int Dim>
void PressureFactors<Dim>::prepare(const SparseRows& matrix, std::span<const Index<Dim>> site,
                                   std::span<const double> m_i, std::span<const std::uint32_t> node,
                                   double viscous_part) {
  find_order(site, node);
  find_envelope(matrix);
  is_complete_ = envelope_cost(first_) <= widest && factorize_envelope(matrix);
  if (!is_complete_) incomplete_.factorize(matrix);
  of_mass_.resize(viscous_part == 0 ? 0 : node.size());
  for_each_row(of_mass_.size(), [&](std::size_t r) { of_mass_[r] = viscous_part / m_i[node[r]]; });
}

template <int Dim>
bool PressureFactors<Dim>::complete(const SparseRows& matrix) {
  if (is_complete_) return false;
  return is_complete_ = factorize_envelope(matrix);
}

template <int Dim>
void PressureFactors<Dim>::solve(const Values& r, Values& out) {
  if (is_complete_) {
    ordered_.resize(r.size());
    for (std::size_t i = 0; i < order_.size(); ++i) ordered_[i] = r[order_[i]];
    complete_.solve(ordered_);
    for (std::size_t i = 0; i < order_.size(); ++i) out[order_[i]] = ordered_[i];
  } else {
    out = r;
    incomplete_.solve(out);
  }
  for (std::size_t i = 0; i < of_mass_.size(); ++i) out[i] += of_mass_[i] * r[i];
}

template double viscous_part<2>(const Coefficients&, const Grid<2>&, const Fluid&, const matrix::StabilizationScale&);
template double viscous_part<3>(const Coefficients&, const Grid<3>&, const Fluid&, const matrix::StabilizationScale&);
template class PressureFactors<2>;
template class PressureFactors<3>;

}  // namespace minamo
