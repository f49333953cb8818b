#include "systems/equal_order/mass_balance.hpp"

#include "systems/equal_order/slope_matrices.hpp"
#include "systems/grid/node_neighbours.hpp"

#include <algorithm>
#include <optional>

namespace minamo {

namespace {

/// D^c_IJ of a cell at [Dim (support_size I + J) + d].
template <int Dim>
using CellDivergence = std::array<double, Dim * support_size<Dim> * support_size<Dim>>;

/// A vector per node of a cell.
template <int Dim>
using AtCellNodes = std::array<Vec<Dim>, support_size<Dim>>;

template <int Dim>
void find_cell_divergence(const Support<Dim>& support, SlopeMatrices<Dim>& matrices, CellDivergence<Dim>& divergence) {
  constexpr std::size_t nodes = support_size<Dim>;
  const PairPlaces<Dim>& places = pair_places<Dim>();
  const double unit = matrices.volume() * support.per_spacing;
  for (std::size_t d = 0; d < Dim; ++d) {
    const double* slopes = matrices.weight_slope(d).data();
    for (std::size_t i = 0; i < nodes; ++i) {
      for (std::size_t j = 0; j < nodes; ++j) {
        divergence[Dim * (nodes * i + j) + d] = unit * slopes[places.in_cell[i][j]];
      }
    }
  }
}

/// Adds what a cell has of D_IJ.
template <int Dim, class Rows>
void add_divergence(const Support<Dim>& support, std::span<const std::int32_t> row, const CellDivergence<Dim>& of_cell,
                    const Rows& rows) {
  constexpr std::size_t nodes = support_size<Dim>;
  const PairPlaces<Dim>& places = pair_places<Dim>();
  for (std::size_t i = 0; i < nodes; ++i) {
    if (row[support.node[i]] < 0) continue;
    double* divergence = rows[static_cast<std::size_t>(row[support.node[i]])].data();
    // Nodes side by side along x are side by side in the stencil.
    for (std::size_t j = 0; j < nodes; j += 3) {
      double* to = divergence + Dim * places.in_stencil[i][j];
      for (std::size_t n = 0; n < 3 * Dim; ++n) to[n] += of_cell[Dim * (nodes * i + j) + n];
    }
  }
}

/// Adds tau_c sum_J D^c_JI . q_J to the sources of a cell.
template <int Dim>
void add_source(const Support<Dim>& support, std::span<const std::int32_t> row, const CellDivergence<Dim>& of_cell,
                double tau, const AtCellNodes<Dim>& q, std::span<double> source) {
  constexpr std::size_t nodes = support_size<Dim>;
  for (std::size_t i = 0; i < nodes; ++i) {
    if (row[support.node[i]] < 0) continue;
    double sum = 0;
    for (std::size_t j = 0; j < nodes; ++j) {
      for (std::size_t d = 0; d < Dim; ++d) {
        sum += of_cell[Dim * (nodes * j + i) + d] * q[j][static_cast<Eigen::Index>(d)];
      }
    }
    source[static_cast<std::size_t>(row[support.node[i]])] += tau * sum;
  }
}

/// Adds tau_c rho_c D^c_JI to the accelerations of active J in the rows of I.
template <int Dim, class Rows>
void add_gradient(const Support<Dim>& support, std::span<const std::int32_t> row, const CellDivergence<Dim>& of_cell,
                  double tau_rho, const Rows& rows) {
  constexpr std::size_t nodes = support_size<Dim>;
  const PairPlaces<Dim>& places = pair_places<Dim>();
  for (std::size_t i = 0; i < nodes; ++i) {
    if (row[support.node[i]] < 0) continue;
    double* stabilization = rows[static_cast<std::size_t>(row[support.node[i]])].data();
    for (std::size_t j = 0; j < nodes; ++j) {
      if (row[support.node[j]] < 0) continue;
      double* to = stabilization + (Dim + 1) * places.in_stencil[i][j];
      for (std::size_t d = 0; d < Dim; ++d) to[d] += tau_rho * of_cell[Dim * (nodes * j + i) + d];
    }
  }
}

/// Where tau_c rho_c is the same in all cells G_IJ is a multiple of D_JI: a pass over the rows, which in 3-D takes
/// less time than to add it up, by 3 % of a step.
template <int Dim, class Force>
void fill_from_divergence(double tau_rho, std::span<const std::int32_t> row,
                          std::span<const typename matrix::Neighbour<Dim>::value_type> neighbour,
                          std::span<const typename matrix::Divergence<Dim>::value_type> divergence, const Force& force,
                          std::span<typename matrix::Stabilization<Dim>::value_type> stabilization,
                          std::span<double> source) {
  constexpr std::size_t rows_per_task = 256;
  const auto of_row = [&](std::size_t r) {
    stabilization[r].fill(0);
    double sum = 0;
    for_each_neighbour<Dim>(neighbour[r], [&](std::size_t k, std::uint32_t j) {
      if (row[j] < 0) return;
      const Vec<Dim> f = force(j);
      const double* back = divergence[static_cast<std::size_t>(row[j])].data() + Dim * (stencil_size<Dim> - 1 - k);
      for (std::size_t d = 0; d < Dim; ++d) {
        const double entry = tau_rho * back[d];
        stabilization[r][(Dim + 1) * k + d] = entry;
        sum += entry * f[static_cast<Eigen::Index>(d)];
      }
    });
    source[r] = sum;
  };
  for_each_row(source.size(), of_row, rows_per_task);
}

/// tau_c rho_c, if it is the same in all cells.
std::optional<double> same_everywhere(std::span<const double> rho_c, std::span<const double> tau_c) {
  for (std::size_t c = 1; c < tau_c.size(); ++c) {
    if (tau_c[c] * rho_c[c] != tau_c[0] * rho_c[0]) return std::nullopt;
  }
  return tau_c.empty() ? 0 : tau_c[0] * rho_c[0];
}

}  // namespace

template <int Dim>
void AssembleDivergence<Dim>::operator()(Read<Rates> rates, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<Moments<Dim>> moments, Read<cell::Density> rho_c, Read<cell::Tau> tau_c,
                                         Read<node::Row> row, Read<node::BodyForce<Dim>> b_i,
                                         Read<node::PredictedAcceleration<Dim>> a_predicted,
                                         Read<node::Displacement<Dim>> u_i, Read<matrix::Neighbour<Dim>> neighbour,
                                         Write<matrix::Divergence<Dim>> divergence,
                                         Write<matrix::Stabilization<Dim>> stabilization,
                                         Write<matrix::StabilizationSource> source) const {
  // b - a, as far as a is known.
  const auto force = [&](std::size_t j) -> Vec<Dim> {
    return b_i[j] - (a_predicted[j] + rates->acceleration * u_i[j]);
  };
  const auto tau_rho = same_everywhere(rho_c.span(), tau_c.span());
  clear_rows(divergence.span());
  if (!tau_rho) {
    clear_rows(stabilization.span());
    std::fill(source.begin(), source.end(), 0.0);
  }
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    CellDivergence<Dim> of_cell;
    find_cell_divergence<Dim>(support, matrices, of_cell);
    add_divergence<Dim>(support, row.span(), of_cell, divergence.span());
    if (tau_rho) return;
    AtCellNodes<Dim> forces;
    for (std::size_t k = 0; k < forces.size(); ++k) {
      forces[k] = row[support.node[k]] < 0 ? Vec<Dim>(Vec<Dim>::Zero()) : force(support.node[k]);
    }
    add_gradient<Dim>(support, row.span(), of_cell, tau_c[c] * rho_c[c], stabilization.span());
    add_source<Dim>(support, row.span(), of_cell, tau_c[c] * rho_c[c], forces, source.span());
  });
  if (!tau_rho) return;
  fill_from_divergence<Dim>(*tau_rho, row.span(), neighbour.span(), divergence.span(), force, stabilization.span(),
                            source.span());
}

template <int Dim>
void AssembleDivergenceOss<Dim>::operator()(
    Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments, Read<Fluid> fluid,
    Read<cell::Density> rho_c, Read<cell::Tau> tau_c, Read<node::Row> row, Read<node::Mass> m_i,
    Read<node::Capacity> capacity, Read<node::BodyForce<Dim>> b_i, Read<node::PressureGradient<Dim>> g_i,
    Write<matrix::Divergence<Dim>> divergence, Write<matrix::Stabilization<Dim>> stabilization,
    Write<matrix::StabilizationSource> source, Update<matrix::StabilizationScale> scale) const {
  scale->acceleration = 0;
  clear_rows(divergence.span());
  clear_rows(stabilization.span());
  std::fill(source.begin(), source.end(), 0.0);
  constexpr double full_enough = 0.6;  // without this guard the dam break blows up at its surface
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    CellDivergence<Dim> of_cell;
    find_cell_divergence<Dim>(support, matrices, of_cell);
    AtCellNodes<Dim> g;
    for (std::size_t k = 0; k < g.size(); ++k) {
      const std::size_t j = support.node[k];
      const bool full = m_i[j] > full_enough * fluid->density * capacity[j];
      g[k] = row[j] < 0 ? Vec<Dim>(Vec<Dim>::Zero()) : full ? g_i[j] : Vec<Dim>(rho_c[c] * b_i[j]);
    }
    add_divergence<Dim>(support, row.span(), of_cell, divergence.span());
    add_source<Dim>(support, row.span(), of_cell, tau_c[c], g, source.span());
  });
}

template <int Dim>
void AssembleLaplacian<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                        Read<Moments<Dim>> moments, Read<cell::Tau> tau_c, Read<node::Row> row,
                                        Update<matrix::Stabilization<Dim>> stabilization) const {
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    CellMatrix<Dim> sum{};
    for (std::size_t d = 0; d < Dim; ++d) {
      const CellMatrix<Dim>& squares = matrices.slope_slope(d, d);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += squares[k];
    }
    const double scale = tau_c[c] * matrices.volume() * support.per_spacing * support.per_spacing;
    add_to_rows<Dim>(support, row.span(), sum, scale, Dim + 1, Dim, stabilization.span());
  });
}

template struct AssembleDivergence<2>;
template struct AssembleDivergence<3>;
template struct AssembleDivergenceOss<2>;
template struct AssembleDivergenceOss<3>;
template struct AssembleLaplacian<2>;
template struct AssembleLaplacian<3>;

}  // namespace minamo
