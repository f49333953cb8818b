#include "systems/assemble/matrices.hpp"

#include "systems/assemble/slope_matrices.hpp"

namespace minamo {

template <int Dim>
void AssembleDivergence<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<Moments<Dim>> moments, Read<node::Row> row,
                                         Write<matrix::Divergence<Dim>> divergence) const {
  const auto rows = divergence.span();
  clear_rows(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    std::array<const double*, Dim> slopes;
    for (std::size_t d = 0; d < Dim; ++d) slopes[d] = matrices.weight_slope(d).data();
    const double scale = matrices.volume() * support.per_spacing;
    for_each_pair<Dim>(support, row.span(), Dim, rows, [&](std::size_t pair, std::size_t, double* entries) {
      for (std::size_t d = 0; d < Dim; ++d) entries[d] += scale * slopes[d][pair];
    });
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
    SlopeMatrices<Dim> matrices(support, *moments, c);
    CellMatrix<Dim> sum{};
    for (std::size_t d = 0; d < Dim; ++d) {
      const CellMatrix<Dim>& matrix = matrices.slope_slope(d, d);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += matrix[k];
    }
    const double scale = matrices.volume() * support.per_spacing * support.per_spacing;
    add_to_rows<Dim>(support, row.span(), sum, scale, 1, 0, rows);
  });
}

template <int Dim>
void LaplacianFromViscosity<Dim>::operator()(Read<Fluid> fluid, Read<matrix::Viscosity<Dim>> viscosity,
                                             Write<matrix::Laplacian<Dim>> laplacian) const {
  const double per_trace = 1 / ((Dim + 1) * fluid->viscosity);
  for_each_row(
      laplacian.span().size(),
      [&](std::size_t r) {
        for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
          double trace = 0;
          for (std::size_t d = 0; d < Dim; ++d) trace += viscosity[r][Dim * (Dim * k + d) + d];
          laplacian[r][k] = per_trace * trace;
        }
      },
      256);
}

template <int Dim>
void AssembleViscosity<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<Fluid> fluid, Read<node::Row> row,
                                        Write<matrix::Viscosity<Dim>> viscosity) const {
  const auto rows = viscosity.span();
  clear_rows(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    std::array<std::array<const double*, Dim>, Dim> slopes{};
    for (std::size_t i = 0; i < Dim; ++i) {
      for (std::size_t j = i; j < Dim; ++j) slopes[i][j] = matrices.slope_slope(i, j).data();
    }
    const double scale = matrices.volume() * fluid->viscosity * support.per_spacing * support.per_spacing;
    for_each_pair<Dim>(support, row.span(), Dim * Dim, rows, [&](std::size_t pair, std::size_t back, double* entries) {
      const auto products = [&](std::size_t i, std::size_t j) {
        return i <= j ? slopes[i][j][pair] : slopes[j][i][back];
      };
      double laplacian = 0;
      for (std::size_t d = 0; d < Dim; ++d) laplacian += products(d, d);
      for (std::size_t i = 0; i < Dim; ++i) {
        for (std::size_t j = 0; j < Dim; ++j) {
          const double own = i == j ? laplacian : 0;
          entries[Dim * i + j] += scale * (products(j, i) + own);
        }
      }
    });
  });
}

template struct AssembleDivergence<2>;
template struct AssembleDivergence<3>;
template struct AssembleLaplacian<2>;
template struct AssembleLaplacian<3>;
template struct LaplacianFromViscosity<2>;
template struct LaplacianFromViscosity<3>;
template struct AssembleViscosity<2>;
template struct AssembleViscosity<3>;

}  // namespace minamo
