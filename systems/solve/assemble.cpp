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
    std::array<CellMatrix<Dim>, Dim> slopes;
    for (std::size_t d = 0; d < Dim; ++d) {
      slopes[d] = integrate<Dim>(moments->of_cell[c], slope_factors<Dim>(support, -1, static_cast<int>(d)));
    }
    for_each_pair<Dim>(support, row.span(), Dim, rows, [&](std::size_t pair, std::size_t, double* entries) {
      for (std::size_t d = 0; d < Dim; ++d) entries[d] += support.per_spacing * slopes[d][pair];
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
    CellMatrix<Dim> sum{};
    for (int d = 0; d < Dim; ++d) {
      const auto matrix = integrate<Dim>(moments->of_cell[c], slope_factors<Dim>(support, d, d));
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += matrix[k];
    }
    add_to_rows<Dim>(support, row.span(), sum, support.per_spacing * support.per_spacing, 1, 0, rows);
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

namespace {

/// sum_p V_p of slope of I in direction i times slope of J in direction j, for i <= j.
template <int Dim>
struct SlopeProducts {
  std::array<std::array<CellMatrix<Dim>, Dim>, Dim> of;

  SlopeProducts(const Support<Dim>& support, const std::array<double, stencil_size<Dim>>& moments) {
    for (std::size_t i = 0; i < Dim; ++i) {
      for (std::size_t j = i; j < Dim; ++j) {
        of[i][j] = integrate<Dim>(moments, slope_factors<Dim>(support, static_cast<int>(i), static_cast<int>(j)));
      }
    }
  }
  double operator()(std::size_t i, std::size_t j, std::size_t pair, std::size_t back) const {
    return i <= j ? of[i][j][pair] : of[j][i][back];
  }
};

}  // namespace

template <int Dim>
void AssembleViscosity<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<Fluid> fluid, Read<node::Row> row,
                                        Write<matrix::Viscosity<Dim>> viscosity) const {
  const auto rows = viscosity.span();
  clear_rows(rows);
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    const double scale = fluid->viscosity * support.per_spacing * support.per_spacing;
    const SlopeProducts<Dim> products(support, moments->of_cell[c]);
    for_each_pair<Dim>(support, row.span(), Dim * Dim, rows, [&](std::size_t pair, std::size_t back, double* entries) {
      double laplacian = 0;
      for (std::size_t d = 0; d < Dim; ++d) laplacian += products(d, d, pair, back);
      for (std::size_t i = 0; i < Dim; ++i) {
        for (std::size_t j = 0; j < Dim; ++j) {
          const double own = i == j ? laplacian : 0;
          entries[Dim * i + j] += scale * (products(j, i, pair, back) + own);
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
