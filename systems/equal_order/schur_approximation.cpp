#include "systems/equal_order/schur_approximation.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// A row is cut where at least so much of the volume around its node is filled. Fewer whole rows save less in the
/// factorization than they cost in iterations.
constexpr double full_share = 0.9;

constexpr std::size_t schur_rows_per_task = 64;

/// How often N counts as zero: sums that cancel leave roundings.
constexpr double roundings = 1e-13;

double sum(const Four& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/// Whether the wide stencil does not meet itself around a short periodic axis.
template <int Dim>
bool wide_stencil_fits(const Grid<Dim>& grid) {
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)] && grid.nodes(d) < 9) return false;
  }
  return true;
}

/// Of a place of the stencil of 5^d, what it adds to one in 9^d.
template <int Dim>
constexpr std::array<std::size_t, stencil_size<Dim>> make_wide_places() {
  std::array<std::size_t, stencil_size<Dim>> places{};
  for (std::size_t k = 0; k < places.size(); ++k) {
    for (std::size_t d = 0, rest = k, step = 1; d < static_cast<std::size_t>(Dim); ++d, rest /= 5, step *= 9) {
      places[k] += rest % 5 * step;
    }
  }
  return places;
}
template <int Dim>
constexpr auto wide_places = make_wide_places<Dim>();

/// Whether the lines at K - I and J - K may be one at J - I that is no further than `reach` from that of I.
template <int Dim>
bool is_within(std::size_t to_k, std::size_t from_k, std::size_t reach) {
  for (int d = 1; d < Dim; ++d, to_k /= 5, from_k /= 5) {
    const std::size_t at = to_k % 5 + from_k % 5;
    if (at + reach < 4 || at > 4 + reach) return false;
  }
  return true;
}

}  // namespace

template <int Dim>
struct SchurApproximation<Dim>::WideRow {
  static constexpr std::size_t size = power(9, Dim);
  std::array<Four, size> sum{};  ///< by directions
  std::array<std::uint32_t, size> row;
};

/// Adds c_v N (c_a m)^-1 D^T.
template <int Dim>
void SchurApproximation<Dim>::add_surface(const From& from, std::size_t r, WideRow& wide) const {
  const auto& gradient = from.schur.gradient(r);
  const auto& neighbours = from.schur.neighbours(r);
  double largest = 0;
  for (const Four& entry : gradient) {
    for (std::size_t d = 0; d < Dim; ++d) largest = std::max(largest, std::abs(entry[d]));
  }
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::size_t between = neighbours[k];
    if (between == from.schur.rows()) continue;
    Four weight{};
    bool is_zero = true;
    for (std::size_t d = 0; d < Dim; ++d) {
      weight[d] = gradient[k][d] + from.terms.divergence[r][Dim * k + d];
      is_zero = is_zero && std::abs(weight[d]) <= roundings * largest;
    }
    if (is_zero) continue;
    weight *= per_mass_[between];
    const auto& of_between = from.schur.gradient(between);
    const auto& beyond = from.schur.neighbours(between);
    for (std::size_t line = 0; line < stencil_size<Dim>; line += 5) {
      if (!is_within<Dim>(k / 5, line / 5, reach_[r])) continue;
      const std::size_t first = wide_places<Dim>[k] + wide_places<Dim>[line];
      for (std::size_t x = 0; x < 5; ++x) {
        wide.sum[first + x] += weight * of_between[line + x];
        wide.row[first + x] = beyond[line + x];
      }
    }
  }
}

/// Adds the entry at a place to those of a row. They rise but across the ends of periodic axes.
template <int Dim>
void SchurApproximation<Dim>::add_entry(std::size_t r, const WideRow& wide, std::size_t at) {
  const double value = sum(wide.sum[at]);
  if (value == 0 || wide.row[at] == rows()) return;
  std::uint32_t place = matrix_.begin[r] + entries_[r]++;
  for (; place > matrix_.begin[r] && matrix_.column[place - 1] > wide.row[at]; --place) {
    matrix_.column[place] = matrix_.column[place - 1];
    matrix_.value[place] = matrix_.value[place - 1];
  }
  matrix_.column[place] = wide.row[at];
  matrix_.value[place] = value;
}

template <int Dim>
void SchurApproximation<Dim>::fill_row(const From& from, std::size_t r) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  constexpr std::size_t corner = 2 * (WideRow::size - 1) / 8;  // two nodes before along every axis
  WideRow wide;
  wide.row.fill(static_cast<std::uint32_t>(rows()));
  add_surface(from, r, wide);
  // Within the stencil, T lies in the place that its sum leaves for pressures.
  const auto& near = from.schur.divergence(r);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::size_t at = corner + wide_places<Dim>[k];
    wide.sum[at][Dim] = from.of_laplacian * near[k][Dim];
    wide.row[at] = from.schur.neighbours(r)[k];
  }
  const double e = from.schur.pressure_of_mass(r);
  wide.sum[WideRow::size / 2][Dim] += e;
  entries_[r] = 0;
  if (reach_[r] == 2) {
    for (const std::size_t place : wide_places<Dim>) add_entry(r, wide, corner + place);
  } else {
    for (std::size_t at = 0; at < WideRow::size; ++at) add_entry(r, wide, at);
  }
  scale_[r] = 1 / std::sqrt(std::max(sum(wide.sum[WideRow::size / 2]), near[own][Dim] + e));
}

/// Also gives every row room for all entries that it may have.
template <int Dim>
void SchurApproximation<Dim>::find_reach(const From& from, const Grid<Dim>& grid, std::span<const double> capacity,
                                         const Fluid& fluid) {
  const Operators<Dim>& t = from.terms;
  const bool may_be_whole = wide_stencil_fits(grid);
  for_each_row(rows(), [&](std::size_t r) {
    const std::uint32_t i = t.node[r];
    const bool is_full = t.m_i[i] >= full_share * fluid.density * capacity[i];
    reach_[r] = is_full || !may_be_whole ? 2 : 4;
    for (std::size_t d = 0; d < 4; ++d) {
      per_mass_[r][d] = d >= Dim || t.is_fixed(r, d) ? 0 : t.c_v / (t.c_a * t.m_i[i]);
    }
  });
  matrix_.begin.resize(rows() + 1);
  for (std::size_t r = 0; r < rows(); ++r) {
    const std::size_t room = reach_[r] == 2 ? stencil_size<Dim> : WideRow::size;
    matrix_.begin[r + 1] = matrix_.begin[r] + static_cast<std::uint32_t>(room);
  }
  matrix_.column.resize(matrix_.begin.back());
  matrix_.value.resize(matrix_.begin.back());
}

template <int Dim>
void SchurApproximation<Dim>::close_gaps() {
  std::uint32_t end = 0;
  for (std::size_t r = 0; r < rows(); ++r) {
    const auto begin = static_cast<std::ptrdiff_t>(matrix_.begin[r]);
    const auto count = static_cast<std::ptrdiff_t>(entries_[r]);
    std::copy_n(matrix_.column.begin() + begin, count, matrix_.column.begin() + end);
    std::copy_n(matrix_.value.begin() + begin, count, matrix_.value.begin() + end);
    matrix_.begin[r] = end;
    end += entries_[r];
  }
  matrix_.begin.back() = end;
  matrix_.column.resize(end);
  matrix_.value.resize(end);
}

template <int Dim>
void SchurApproximation<Dim>::assemble(const Operators<Dim>& t, const Grid<Dim>& grid, std::span<const double> capacity,
                                       const Fluid& fluid, double of_laplacian, const SchurOperator<Dim>& schur) {
  const From from{t, schur, of_laplacian};
  scale_.resize(schur.rows());
  reach_.resize(schur.rows());
  entries_.resize(schur.rows());
  per_mass_.resize(schur.rows());
  find_reach(from, grid, capacity, fluid);
  for_each_row(
      rows(), [&](std::size_t r) { fill_row(from, r); }, schur_rows_per_task);
  close_gaps();
}

template class SchurApproximation<2>;
template class SchurApproximation<3>;

}  // namespace minamo
