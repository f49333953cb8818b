#include "systems/solve/assemble.hpp"

namespace minamo {

namespace {

/// The pair factors with a slope of I in direction i and a slope of J in direction j; -1: no slope.
template <int Dim>
PairFactors<Dim> factors(const Support<Dim>& support, int slope_of_i, int slope_of_j) {
  PairFactors<Dim> factors;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const AxisBasis& basis = *support.basis[axis];
    const auto& without_j = d == slope_of_i ? basis.slope_weight : basis.weight_weight;
    const auto& with_j = d == slope_of_i ? basis.slope_slope : basis.weight_slope;
    factors[axis] = d == slope_of_j ? &with_j : &without_j;
  }
  return factors;
}

/// Adds scale * matrix(I, J) to entry [width * stencil place + component] of the row of every active I.
template <int Dim, class Rows>
void add_to_rows(const Support<Dim>& support, std::span<const std::int32_t> row, const CellMatrix<Dim>& matrix,
                 double scale, std::size_t width, std::size_t component, const Rows& rows) {
  const PairPlaces<Dim>& places = pair_places<Dim>();
  for (std::size_t i = 0; i < support_size<Dim>; ++i) {
    const std::int32_t r = row[support.node[i]];
    if (r < 0) continue;
    auto& entries = rows[static_cast<std::size_t>(r)];
    for (std::size_t j = 0; j < support_size<Dim>; ++j) {
      entries[width * places.in_stencil[i][j] + component] += scale * matrix[places.in_cell[i][j]];
    }
  }
}

template <class Rows>
void clear(const Rows& rows) {
  constexpr std::size_t rows_per_task = 256;
  for_each_row(rows.size(), [&](std::size_t r) { rows[r].fill(0); }, rows_per_task);
}

}  // namespace

template <int Dim>
void AssembleDivergence<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<Moments<Dim>> moments, Read<node::Row> row,
                                         Write<matrix::Divergence<Dim>> divergence) const {
  const auto rows = divergence.span();
  clear(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell.node);
    for (int d = 0; d < Dim; ++d) {
      const auto matrix = integrate<Dim>(moments->of_cell[c], factors<Dim>(support, -1, d));
      add_to_rows<Dim>(support, row.span(), matrix, support.per_spacing, Dim, static_cast<std::size_t>(d), rows);
    }
  });
}

template <int Dim>
void AssembleLaplacian<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<node::Row> row,
                                        Write<matrix::Laplacian<Dim>> laplacian) const {
  const auto rows = laplacian.span();
  clear(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell.node);
    CellMatrix<Dim> sum{};
    for (int d = 0; d < Dim; ++d) {
      const auto matrix = integrate<Dim>(moments->of_cell[c], factors<Dim>(support, d, d));
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += matrix[k];
    }
    add_to_rows<Dim>(support, row.span(), sum, support.per_spacing * support.per_spacing, 1, 0, rows);
  });
}

template <int Dim>
void AssembleViscosity<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<Fluid> fluid, Read<node::Row> row,
                                        Write<matrix::Viscosity<Dim>> viscosity) const {
  const auto rows = viscosity.span();
  clear(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell.node);
    const double scale = fluid->viscosity * support.per_spacing * support.per_spacing;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        // Slope of I in direction i, of J in direction j: once in entry (j, i), and for i = j in the whole diagonal.
        const auto matrix = integrate<Dim>(moments->of_cell[c], factors<Dim>(support, i, j));
        const auto add = [&](int a, int b) {
          add_to_rows<Dim>(support, row.span(), matrix, scale, Dim * Dim, static_cast<std::size_t>(Dim * a + b), rows);
        };
        add(j, i);
        for (int k = 0; k < Dim && i == j; ++k) add(k, k);
      }
    }
  });
}

template struct AssembleDivergence<2>;
template struct AssembleDivergence<3>;
template struct AssembleLaplacian<2>;
template struct AssembleLaplacian<3>;
template struct AssembleViscosity<2>;
template struct AssembleViscosity<3>;

}  // namespace minamo
