#include "systems/solve/assemble.hpp"

#include "systems/solve/cell_matrix.hpp"

namespace minamo {

template <int Dim>
void AssembleDivergence<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<Moments<Dim>> moments, Read<node::Row> row,
                                         Write<matrix::Divergence<Dim>> divergence) const {
  const auto rows = divergence.span();
  clear_rows(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    for (int d = 0; d < Dim; ++d) {
      const auto matrix = integrate<Dim>(moments->of_cell[c], slope_factors<Dim>(support, -1, d));
      add_to_rows<Dim>(support, row.span(), matrix, support.per_spacing, Dim, static_cast<std::size_t>(d), rows);
    }
  });
}

template <int Dim>
void AssembleLaplacian<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<node::Row> row,
                                        Write<matrix::Laplacian<Dim>> laplacian) const {
  const auto rows = laplacian.span();
  clear_rows(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    CellMatrix<Dim> sum{};
    for (int d = 0; d < Dim; ++d) {
      const auto matrix = integrate<Dim>(moments->of_cell[c], slope_factors<Dim>(support, d, d));
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
  clear_rows(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    const double scale = fluid->viscosity * support.per_spacing * support.per_spacing;
    const auto add = [&](const CellMatrix<Dim>& matrix, int a, int b) {
      add_to_rows<Dim>(support, row.span(), matrix, scale, Dim * Dim, static_cast<std::size_t>(Dim * a + b), rows);
    };
    // With slopes of I in direction i and of J in direction j: entry (j, i), and for i = j the whole diagonal.
    std::array<CellMatrix<Dim>, Dim> squares;
    CellMatrix<Dim> laplacian{};
    for (int i = 0; i < Dim; ++i) {
      auto& square = squares[static_cast<std::size_t>(i)];
      square = integrate<Dim>(moments->of_cell[c], slope_factors<Dim>(support, i, i));
      for (std::size_t k = 0; k < square.size(); ++k) laplacian[k] += square[k];
      for (int j = i + 1; j < Dim; ++j) {
        const auto matrix = integrate<Dim>(moments->of_cell[c], slope_factors<Dim>(support, i, j));
        add(matrix, j, i);
        add(transposed<Dim>(matrix), i, j);
      }
    }
    for (int i = 0; i < Dim; ++i) {
      auto& square = squares[static_cast<std::size_t>(i)];
      for (std::size_t k = 0; k < square.size(); ++k) square[k] += laplacian[k];
      add(square, i, i);
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
