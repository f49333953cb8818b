#include "systems/equal_order/viscosity.hpp"

#include "systems/equal_order/slope_matrices.hpp"

namespace minamo {

template <int Dim>
void AssembleViscosity<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<cell::Viscosity> mu_c,
                                        Optional<Read<cell::BulkViscosity>> tau_2, Read<cell::Tau> tau_c,
                                        Read<node::Row> row, Write<matrix::Viscosity<Dim>> viscosity,
                                        Update<matrix::Stabilization<Dim>> stabilization) const {
  clear_rows(viscosity.span());
  const PairPlaces<Dim>& places = pair_places<Dim>();
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    std::array<std::array<const double*, Dim>, Dim> slopes{};
    for (std::size_t i = 0; i < Dim; ++i) {
      for (std::size_t j = i; j < Dim; ++j) slopes[i][j] = matrices.slope_slope(i, j).data();
    }
    // Calls add(r, place in the stencil, products), products(i, j) = sum_p V_p grad_i S_I grad_j S_J in units of h.
    const auto for_each_pair_of_slopes = [&](const auto& add) {
      for (std::size_t node_i = 0; node_i < support_size<Dim>; ++node_i) {
        const std::int32_t r = row[support.node[node_i]];
        if (r < 0) continue;
        for (std::size_t node_j = 0; node_j < support_size<Dim>; ++node_j) {
          const std::size_t pair = places.in_cell[node_i][node_j];
          const std::size_t back = places.in_cell[node_j][node_i];
          add(static_cast<std::size_t>(r), std::size_t{places.in_stencil[node_i][node_j]},
              [&](std::size_t i, std::size_t j) { return i <= j ? slopes[i][j][pair] : slopes[j][i][back]; });
        }
      }
    };
    const double scale = matrices.volume() * mu_c[c] * support.per_spacing * support.per_spacing;
    const double of_laplacian = matrices.volume() * tau_c[c] * support.per_spacing * support.per_spacing;
    for_each_pair_of_slopes([&](std::size_t r, std::size_t k, const auto& products) {
      double laplacian = 0;
      for (std::size_t d = 0; d < Dim; ++d) laplacian += products(d, d);
      double* entries = viscosity[r].data() + Dim * Dim * k;
      for (std::size_t i = 0; i < Dim; ++i) {
        for (std::size_t j = 0; j < Dim; ++j) {
          const double own = i == j ? laplacian : 0;
          entries[Dim * i + j] += scale * (products(j, i) + own);
        }
      }
      stabilization[r][(Dim + 1) * k + Dim] += of_laplacian * laplacian;
    });
    if (!tau_2) return;
    const double bulk = matrices.volume() * tau_2[c] * support.per_spacing * support.per_spacing;
    for_each_pair_of_slopes([&](std::size_t r, std::size_t k, const auto& products) {
      double* entries = viscosity[r].data() + Dim * Dim * k;
      for (std::size_t i = 0; i < Dim; ++i) {
        for (std::size_t j = 0; j < Dim; ++j) entries[Dim * i + j] += bulk * products(i, j);
      }
    });
  });
}

template struct AssembleViscosity<2>;
template struct AssembleViscosity<3>;

}  // namespace minamo
