#include "systems/solve/pressure_factors.hpp"

#include "engine/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace minamo {

namespace {

/// Multiplications up to which single precision saves less than its failures cost, and from which on an envelope is
/// slower than a sparse factorization, in single and in double precision.
constexpr double narrowest_single = 1e6;
constexpr double widest_single = 1e10;
constexpr double widest_double = 1e9;

/// A pivot that has lost so much of its diagonal has lost it to rounding in single precision. Where few particles have
/// many nodes, pressures hang on e of (E27), a millionth of the diagonal.
constexpr double least_pivot = 1e-3;

/// Steps with whole factors after one that needs them: spray does not vanish from one step to the next.
constexpr int steps_with_whole_factors = 16;

/// Rows from which on, in 3-D, the fill of a complete factorization costs more than the iterations that it saves.
constexpr std::size_t most_complete = 20000;

constexpr std::size_t rows_per_task = 512;

/// The value of an entry in a list, 0 if it is not there.
template <class Entries>
double value_of(const Entries& entries, std::size_t row) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& entry) { return entry.row == row; });
  return found == entries.end() ? 0 : found->value;
}

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
void PressureFactors<Dim>::find_order(const Operators<Dim>& t) {
  order_.resize(t.node.size());
  place_.resize(t.node.size());
  std::array<std::pair<int, std::size_t>, Dim> axes;
  for (std::size_t d = 0; d < axes.size(); ++d) {
    int low = std::numeric_limits<int>::max();
    int high = 0;
    for (const std::uint32_t node : t.node) {
      low = std::min(low, t.site[node][d]);
      high = std::max(high, t.site[node][d]);
    }
    axes[d] = {low - high, d};
  }
  std::sort(axes.begin(), axes.end());
  keys_.resize(order_.size());
  for_each_row(order_.size(), [&](std::size_t r) {
    auto& [key, row] = keys_[r];
    row = static_cast<std::uint32_t>(r);
    for (std::size_t d = 0; d < axes.size(); ++d) key[d] = t.site[t.node[r]][axes[d].second];
  });
  if (!std::is_sorted(keys_.begin(), keys_.end())) std::sort(keys_.begin(), keys_.end());
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    order_[i] = keys_[i].second;
    place_[order_[i]] = i;
  }
}

template <int Dim>
void PressureFactors<Dim>::find_envelope(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles) {
  first_.resize(order_.size());
  for_each_row(
      order_.size(),
      [&](std::size_t r) {
        std::uint32_t& first = first_[place_[r]] = place_[r];
        tiles.for_each_neighbour(r, [&](std::size_t, std::size_t r_j) { first = std::min(first, place_[r_j]); });
      },
      rows_per_task);
  // Far entries may have none across from them.
  const auto include = [&](std::uint32_t row, std::uint32_t column) { first_[row] = std::min(first_[row], column); };
  for (std::size_t r = 0; r < order_.size(); ++r) {
    for (const auto& entry : compact.far_entries(r)) {
      include(place_[r], place_[entry.row]);
      include(place_[entry.row], place_[r]);
    }
  }
}

template <int Dim>
template <class Scalar>
bool PressureFactors<Dim>::factorize_envelope(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles,
                                              double least, EnvelopeLu<Scalar>& factors) {
  factors.start(first_);
  for_each_row(
      order_.size(),
      [&](std::size_t r) {
        const auto add = [&](std::size_t r_j, double value) {
          factors.at(place_[r], place_[r_j]) += static_cast<Scalar>(value);
        };
        compact.for_each_near(tiles, r, add);
        for (const auto& entry : compact.far_entries(r)) add(entry.row, entry.value);
      },
      rows_per_task);
  return factors.factorize(least);
}

template <int Dim>
bool PressureFactors<Dim>::factorize_narrow(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles,
                                            WholeFactors& whole) {
  const double cost = envelope_cost(first_);
  if (whole.steps == 0 && cost > narrowest_single && cost < widest_single) {
    kind_ = Kind::single_envelope;
    if (factorize_envelope(compact, tiles, least_pivot, single_)) return true;
    whole.steps = steps_with_whole_factors;
  }
  kind_ = Kind::double_envelope;
  return cost < widest_double && factorize_envelope(compact, tiles, 0, double_);
}

/// Entries beyond the stencil above the diagonal that have none across from them, by the row across: a
/// partially filled row has some, a full one none.
template <int Dim>
void PressureFactors<Dim>::find_one_sided(const SchurApproximation<Dim>& compact) {
  one_sided_.clear();
  for (std::size_t r = 0; r < order_.size(); ++r) {
    for (const auto& entry : compact.far_entries(r)) {
      const auto& across = compact.far_entries(entry.row);
      const auto is_back = [r](const auto& back) { return back.row == r; };
      if (entry.row > r && std::none_of(across.begin(), across.end(), is_back)) {
        one_sided_.push_back({entry.row, r, entry.value});
      }
    }
  }
  std::sort(one_sided_.begin(), one_sided_.end(),
            [](const auto& a, const auto& b) { return std::tie(a.row, a.column) < std::tie(b.row, b.column); });
}

/// The symmetric part of the compact matrix.
template <int Dim>
bool PressureFactors<Dim>::factorize_symmetric(const SchurApproximation<Dim>& compact, const StencilTiles<Dim>& tiles) {
  find_one_sided(compact);
  auto next = one_sided_.begin();
  sparse_.start(order_.size());
  for (std::size_t r = 0; r < order_.size(); ++r) {
    compact.for_each_near_pair(tiles, r, [&](std::size_t r_j, double value, double back) {
      if (r_j <= r) sparse_.add(r, r_j, (value + back) / 2);
    });
    for (const auto& entry : compact.far_entries(r)) {
      if (entry.row < r) sparse_.add(r, entry.row, (entry.value + value_of(compact.far_entries(entry.row), r)) / 2);
    }
    for (; next != one_sided_.end() && next->row == r; ++next) sparse_.add(r, next->column, next->value / 2);
  }
  return sparse_.factorize(is_incomplete() ? SparseCholesky::Kind::incomplete : SparseCholesky::Kind::complete);
}

/// T + e, with as much of the diagonal as e: never indefinite, and no larger where e alone holds a pressure.
template <int Dim>
bool PressureFactors<Dim>::factorize_pressure(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur) {
  sparse_.start(order_.size());
  for (std::size_t r = 0; r < order_.size(); ++r) {
    const double more = 1e-6 / (compact.scale()[r] * compact.scale()[r]);
    schur.divergence_entries().for_each_neighbour(schur.tiles(), r, Dim, Dim + 1,
                                                  [&](std::size_t, std::size_t r_j, double value) {
                                                    if (r_j <= r && value != 0)
                                                      sparse_.add(r, r_j, value + (r_j == r ? more : 0));
                                                  });
  }
  return sparse_.factorize(is_incomplete() ? SparseCholesky::Kind::incomplete : SparseCholesky::Kind::complete);
}

template <int Dim>
void PressureFactors<Dim>::factorize_sparse(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur) {
  // The symmetric part can be indefinite in spray.
  if (factorize_symmetric(compact, schur.tiles()) || factorize_pressure(compact, schur)) return;
  throw StepRejected("solve: the pressure matrix is not positive definite");
}

template <int Dim>
void PressureFactors<Dim>::prepare(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur,
                                   const Operators<Dim>& terms, double viscous_part, WholeFactors& whole) {
  find_order(terms);
  find_envelope(compact, schur.tiles());
  ordered_.resize(order_.size());
  const bool has_whole = whole.steps > 0;
  const bool is_narrow = factorize_narrow(compact, schur.tiles(), whole);
  if (has_whole) --whole.steps;
  if (!is_narrow) {
    kind_ = Dim == 3 && order_.size() > most_complete && !has_whole ? Kind::incomplete : Kind::complete;
    factorize_sparse(compact, schur);
  }
  of_mass_.clear();
  if (viscous_part == 0) return;
  for (std::size_t r = 0; r < order_.size(); ++r) of_mass_.push_back(viscous_part / terms.m_i[terms.node[r]]);
}

template <int Dim>
bool PressureFactors<Dim>::complete(const SchurApproximation<Dim>& compact, const SchurOperator<Dim>& schur,
                                    WholeFactors& whole) {
  if (!is_incomplete()) return false;
  kind_ = Kind::complete;
  factorize_sparse(compact, schur);
  whole.steps = steps_with_whole_factors;
  return true;
}

template <int Dim>
void PressureFactors<Dim>::solve(const Values& r, Values& out) {
  if (kind_ == Kind::complete || is_incomplete()) {
    out = r;
    sparse_.solve(out);
  } else {
    for (std::size_t i = 0; i < order_.size(); ++i) ordered_[i] = r[order_[i]];
    kind_ == Kind::single_envelope ? single_.solve(ordered_) : double_.solve(ordered_);
    for (std::size_t i = 0; i < order_.size(); ++i) out[order_[i]] = ordered_[i];
  }
  for (std::size_t i = 0; i < of_mass_.size(); ++i) out[i] += of_mass_[i] * r[i];
}

template double viscous_part<2>(const Coefficients&, const Grid<2>&, const Fluid&, const matrix::StabilizationScale&);
template double viscous_part<3>(const Coefficients&, const Grid<3>&, const Fluid&, const matrix::StabilizationScale&);
template class PressureFactors<2>;
template class PressureFactors<3>;

}  // namespace minamo
