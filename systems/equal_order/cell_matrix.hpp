#pragma once
/// \file
/// From cell matrices to the stencil rows of active nodes.

#include "systems/equal_order/moments.hpp"

namespace minamo {

/// The pair factors with a slope of I in direction i and a slope of J in direction j; -1: no slope.
template <int Dim>
PairFactors<Dim> slope_factors(const CellBasis<Dim>& cell, int slope_of_i, int slope_of_j) {
  PairFactors<Dim> factors;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const AxisBasis& basis = *cell[axis];
    const auto& without_j = d == slope_of_i ? basis.slope_weight : basis.weight_weight;
    const auto& with_j = d == slope_of_i ? basis.slope_slope : basis.weight_slope;
    factors[axis] = d == slope_of_j ? &with_j : &without_j;
  }
  return factors;
}

/// Calls add(I J in a CellMatrix, J I in it, entries of the pair) for every active I; `width` entries per neighbour.
template <int Dim, class Rows, class Add>
void for_each_pair(const Support<Dim>& support, std::span<const std::int32_t> row, std::size_t width, const Rows& rows,
                   const Add& add) {
  const PairPlaces<Dim>& places = pair_places<Dim>();
  for (std::size_t i = 0; i < support_size<Dim>; ++i) {
    const std::int32_t r = row[support.node[i]];
    if (r < 0) continue;
    double* entries = rows[static_cast<std::size_t>(r)].data();
    for (std::size_t j = 0; j < support_size<Dim>; ++j) {
      add(places.in_cell[i][j], places.in_cell[j][i], entries + width * places.in_stencil[i][j]);
    }
  }
}

/// Adds scale * matrix(I, J) to entry [width * stencil place + component] of the row of every active I.
template <int Dim, class Rows>
void add_to_rows(const Support<Dim>& support, std::span<const std::int32_t> row, const CellMatrix<Dim>& matrix,
                 double scale, std::size_t width, std::size_t component, const Rows& rows) {
  for_each_pair<Dim>(support, row, width, rows, [&](std::size_t pair, std::size_t, double* entries) {
    entries[component] += scale * matrix[pair];
  });
}

/// Adds sum_J matrix(I, J) at_node(J) to the row of every active I.
template <int Dim, class AtNode>
void add_product(const Support<Dim>& support, std::span<const std::int32_t> row, const CellMatrix<Dim>& matrix,
                 const AtNode& at_node, std::span<double> rows) {
  const PairPlaces<Dim>& places = pair_places<Dim>();
  for (std::size_t i = 0; i < support_size<Dim>; ++i) {
    const std::int32_t r = row[support.node[i]];
    if (r < 0) continue;
    double sum = 0;
    for (std::size_t j = 0; j < support_size<Dim>; ++j) sum += matrix[places.in_cell[i][j]] * at_node(support.node[j]);
    rows[static_cast<std::size_t>(r)] += sum;
  }
}

template <class Rows>
void clear_rows(const Rows& rows) {
  constexpr std::size_t rows_per_task = 256;
  for_each_row(
      rows.size(), [&](std::size_t r) { rows[r].fill(0); }, rows_per_task);
}

}  // namespace minamo
