#include "systems/assemble/mass_balance.hpp"

#include "systems/assemble/slope_matrices.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// The rows of the mass balance.
template <int Dim>
struct MassBalance {
  std::span<typename matrix::Divergence<Dim>::value_type> divergence;
  std::span<typename matrix::Stabilization<Dim>::value_type> stabilization;
  std::span<double> source;

  void clear() const {
    clear_rows(divergence);
    clear_rows(stabilization);
    std::fill(source.begin(), source.end(), 0.0);
  }
};

/// What a cell adds to D_IJ, of PSPG and VMS to G_IJ, and to the source s_I = tau_c sum_J D^c_JI . q_J.
/// \param of_gradient  G^c_IJ over D^c_JI
/// \param q            at the nodes of the cell
template <bool with_gradient, int Dim>
void add_divergence(const Support<Dim>& support, SlopeMatrices<Dim>& matrices, std::span<const std::int32_t> row,
                    double tau, double of_gradient, const std::array<Vec<Dim>, support_size<Dim>>& q,
                    const MassBalance<Dim>& rows) {
  const PairPlaces<Dim>& places = pair_places<Dim>();
  std::array<const double*, Dim> slopes;  // sum_p V_p S_I grad_d S_J in units of h
  for (std::size_t d = 0; d < Dim; ++d) slopes[d] = matrices.weight_slope(d).data();
  const double unit = matrices.volume() * support.per_spacing;
  for (std::size_t i = 0; i < support_size<Dim>; ++i) {
    if (row[support.node[i]] < 0) continue;
    const auto r = static_cast<std::size_t>(row[support.node[i]]);
    double* divergence = rows.divergence[r].data();
    double* stabilization = rows.stabilization[r].data();
    double sum = 0;
    for (std::size_t j = 0; j < support_size<Dim>; ++j) {
      const std::size_t pair = places.in_cell[i][j];
      const std::size_t back = places.in_cell[j][i];
      const std::size_t k = places.in_stencil[i][j];
      for (std::size_t d = 0; d < Dim; ++d) {
        divergence[Dim * k + d] += unit * slopes[d][pair];
        if constexpr (with_gradient) stabilization[(Dim + 1) * k + d] += unit * of_gradient * slopes[d][back];
        sum += slopes[d][back] * q[j][static_cast<Eigen::Index>(d)];
      }
    }
    rows.source[r] += tau * unit * sum;
  }
}

}  // namespace

template <int Dim>
void AssembleDivergence<Dim>::operator()(Read<Rates> rates, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                         Read<Moments<Dim>> moments, Read<cell::Density> rho_c, Read<cell::Tau> tau_c,
                                         Read<node::Row> row, Read<node::BodyForce<Dim>> b_i,
                                         Read<node::PredictedAcceleration<Dim>> a_predicted,
                                         Read<node::Displacement<Dim>> u_i, Write<matrix::Divergence<Dim>> divergence,
                                         Write<matrix::Stabilization<Dim>> stabilization,
                                         Write<matrix::StabilizationSource> source) const {
  const MassBalance<Dim> rows{divergence.span(), stabilization.span(), source.span()};
  rows.clear();
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    std::array<Vec<Dim>, support_size<Dim>> force;  // rho (b - a), as far as a is known
    for (std::size_t k = 0; k < force.size(); ++k) {
      const std::size_t j = support.node[k];
      force[k].setZero();
      if (row[j] >= 0) force[k] = rho_c[c] * (b_i[j] - (a_predicted[j] + rates->acceleration * u_i[j]));
    }
    add_divergence<true, Dim>(support, matrices, row.span(), tau_c[c], tau_c[c] * rho_c[c], force, rows);
  });
}

template <int Dim>
void AssembleDivergenceOss<Dim>::operator()(
    Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments, Read<Fluid> fluid,
    Read<cell::Density> rho_c, Read<cell::Tau> tau_c, Read<node::Row> row, Read<node::Mass> m_i,
    Read<node::Capacity> capacity, Read<node::BodyForce<Dim>> b_i, Read<node::PressureGradient<Dim>> g_i,
    Write<matrix::Divergence<Dim>> divergence, Write<matrix::Stabilization<Dim>> stabilization,
    Write<matrix::StabilizationSource> source, Update<matrix::StabilizationScale> scale) const {
  scale->acceleration = 0;
  const MassBalance<Dim> rows{divergence.span(), stabilization.span(), source.span()};
  rows.clear();
  constexpr double full_enough = 0.6;  // without this guard the dam break blows up at its surface
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    SlopeMatrices<Dim> matrices(support, *moments, c);
    std::array<Vec<Dim>, support_size<Dim>> g;
    for (std::size_t k = 0; k < g.size(); ++k) {
      const std::size_t j = support.node[k];
      const bool full = m_i[j] > full_enough * fluid->density * capacity[j];
      g[k] = row[j] < 0 ? Vec<Dim>(Vec<Dim>::Zero()) : full ? g_i[j] : Vec<Dim>(rho_c[c] * b_i[j]);
    }
    add_divergence<false, Dim>(support, matrices, row.span(), tau_c[c], 0, g, rows);
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
