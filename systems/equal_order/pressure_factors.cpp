#include "systems/equal_order/pressure_factors.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Multiplications from which on an envelope is slower than incomplete factors: in 3-D a step of 27 648 particles
/// takes 1.35 times as long with 1e10.
template <int Dim>
constexpr double widest = Dim == 2 ? 1e10 : 1e8;

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
  std::array<std::pair<int, std::size_t>, Dim> axes;  // minus length, axis
  for (std::size_t d = 0; d < axes.size(); ++d) {
    const auto along = [&](std::uint32_t i, std::uint32_t j) { return site[i][d] < site[j][d]; };
    const auto [low, high] = std::minmax_element(node.begin(), node.end(), along);
    axes[d] = {low == node.end() ? 0 : site[*low][d] - site[*high][d], d};
  }
  std::sort(axes.begin(), axes.end());
  keys_.resize(node.size());
  for (std::uint32_t r = 0; r < node.size(); ++r) {
    for (std::size_t d = 0; d < axes.size(); ++d) keys_[r].first[d] = site[node[r]][axes[d].second];
    keys_[r].second = r;
  }
  if (!std::is_sorted(keys_.begin(), keys_.end())) std::sort(keys_.begin(), keys_.end());
  place_.resize(node.size());
  for (std::uint32_t i = 0; i < node.size(); ++i) place_[keys_[i].second] = i;
}

template <int Dim>
void PressureFactors<Dim>::find_envelope() {
  const SparseRows& matrix = approximation_.matrix();
  first_.resize(place_.size());
  for (std::uint32_t i = 0; i < first_.size(); ++i) first_[i] = i;
  for (std::size_t r = 0; r < place_.size(); ++r) {
    const std::uint32_t own = place_[r];
    for (std::uint32_t e = matrix.begin[r]; e < matrix.begin[r + 1]; ++e) {
      // Some entries have none across from them.
      const auto [low, high] = std::minmax(own, place_[matrix.column[e]]);
      first_[high] = std::min(first_[high], low);
    }
  }
}

template <int Dim>
bool PressureFactors<Dim>::factorize_envelope() {
  const SparseRows& matrix = approximation_.matrix();
  complete_.start(first_);
  for (std::size_t r = 0; r < place_.size(); ++r) {
    for (std::uint32_t e = matrix.begin[r]; e < matrix.begin[r + 1]; ++e) {
      complete_.at(place_[r], place_[matrix.column[e]]) += matrix.value[e];
    }
  }
  return complete_.factorize();
}

template <int Dim>
void PressureFactors<Dim>::prepare(const Operators<Dim>& t, const SchurOperator<Dim>& schur, const Grid<Dim>& grid,
                                   std::span<const Index<Dim>> site, std::span<const double> capacity,
                                   const Fluid& fluid, const matrix::StabilizationScale& scale) {
  approximation_.assemble(t, grid, capacity, fluid, laplacian_factor(t, fluid, scale), schur);
  find_order(site, t.node);
  find_envelope();
  is_complete_ = envelope_cost(first_) <= widest<Dim> && factorize_envelope();
  if (!is_complete_) incomplete_.factorize(approximation_.matrix());
  const double b = t.viscosity.empty() ? 0 : viscous_part<Dim>(t, grid, fluid, scale);
  of_mass_.resize(b == 0 ? 0 : t.node.size());
  for_each_row(of_mass_.size(), [&](std::size_t r) { of_mass_[r] = b / t.m_i[t.node[r]]; });
}

template <int Dim>
bool PressureFactors<Dim>::complete() {
  if (is_complete_) return false;
  return is_complete_ = factorize_envelope();
}

template <int Dim>
void PressureFactors<Dim>::solve(const Values& r, Values& out) {
  if (is_complete_) {
    ordered_.resize(r.size());
    for (std::size_t i = 0; i < r.size(); ++i) ordered_[place_[i]] = r[i];
    complete_.solve(ordered_);
    for (std::size_t i = 0; i < r.size(); ++i) out[i] = ordered_[place_[i]];
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
