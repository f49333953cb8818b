#include "systems/assemble/stabilization.hpp"

#include "systems/assemble/neighbours.hpp"
#include "systems/transfer/gather.hpp"
#include "systems/transfer/scatter.hpp"

#include <cmath>

namespace minamo {

namespace {

/// (E24). [m^3 s/kg]
double stabilization_time(double dt, double spacing, const Fluid& fluid) {
  return 1 / std::hypot(2 * fluid.density / dt, 4 * fluid.viscosity / (spacing * spacing));
}

/// D_JI . q with I at place k of the stencil of row r_j.
template <int Dim>
double dot(const typename matrix::Divergence<Dim>::value_type& row, std::size_t k, const Vec<Dim>& q) {
  double sum = 0;
  for (std::size_t d = 0; d < Dim; ++d) sum += row[Dim * k + d] * q[static_cast<Eigen::Index>(d)];
  return sum;
}

/// Starts every row with tau L_IJ and no source, and calls add(r, k, j, row_j) for its active neighbours J: k their
/// place in the stencil of row r, row_j their row of D.
template <int Dim, class Add>
void fill_rows(double tau, std::span<const std::int32_t> row,
               std::span<const typename matrix::Neighbour<Dim>::value_type> neighbour,
               std::span<const typename matrix::Divergence<Dim>::value_type> divergence,
               std::span<const typename matrix::Laplacian<Dim>::value_type> laplacian,
               std::span<typename matrix::Stabilization<Dim>::value_type> stabilization, std::span<double> source,
               const Add& add) {
  constexpr std::size_t rows_per_task = 256;
  for_each_row(
      neighbour.size(),
      [&](std::size_t r) {
        stabilization[r].fill(0);
        source[r] = 0;
        for_each_neighbour<Dim>(neighbour[r], [&](std::size_t k, std::uint32_t j) {
          stabilization[r][(Dim + 1) * k + Dim] = tau * laplacian[r][k];
          if (row[j] >= 0) add(r, k, j, divergence[static_cast<std::size_t>(row[j])]);
        });
      },
      rows_per_task);
}

}  // namespace

template <int Dim>
void StabilizePspg<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<node::Row> row,
                                    Read<node::BodyForce<Dim>> b_i, Read<node::KnownAcceleration<Dim>> a_known,
                                    Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                                    Read<matrix::Laplacian<Dim>> laplacian,
                                    Write<matrix::Stabilization<Dim>> stabilization,
                                    Write<matrix::StabilizationSource> source,
                                    Write<matrix::StabilizationScale> scale) const {
  const double tau = stabilization_time(clock->step, grid->spacing, *fluid);
  const double tau_rho = tau * fluid->density;
  *scale = {.pressure = tau, .acceleration = tau_rho};
  fill_rows<Dim>(tau, row.span(), neighbour.span(), divergence.span(), laplacian.span(), stabilization.span(),
                 source.span(), [&](std::size_t r, std::size_t k, std::uint32_t j, const auto& row_j) {
                   const std::size_t back = stencil_size<Dim> - 1 - k;
                   for (std::size_t d = 0; d < Dim; ++d) {
                     stabilization[r][(Dim + 1) * k + d] = tau_rho * row_j[Dim * back + d];
                   }
                   source[r] -= tau_rho * dot<Dim>(row_j, back, a_known[j] - b_i[j]);
                 });
}

template <int Dim>
void StabilizeOss<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<node::Capacity> capacity,
                                   Read<Fluid> fluid, Read<node::Row> row, Read<node::Mass> m_i,
                                   Read<node::BodyForce<Dim>> b_i, Read<node::PressureGradient<Dim>> g_i,
                                   Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                                   Read<matrix::Laplacian<Dim>> laplacian,
                                   Write<matrix::Stabilization<Dim>> stabilization,
                                   Write<matrix::StabilizationSource> source,
                                   Write<matrix::StabilizationScale> scale) const {
  const double tau = stabilization_time(clock->step, grid->spacing, *fluid);
  *scale = {.pressure = tau, .acceleration = 0};
  constexpr double full_enough = 0.6;  // without this guard the dam break blows up at its surface
  fill_rows<Dim>(tau, row.span(), neighbour.span(), divergence.span(), laplacian.span(), stabilization.span(),
                 source.span(), [&](std::size_t r, std::size_t k, std::uint32_t j, const auto& row_j) {
                   const bool full = m_i[j] > full_enough * fluid->density * capacity[j];
                   const Vec<Dim> g = full ? g_i[j] : Vec<Dim>(fluid->density * b_i[j]);
                   source[r] += tau * dot<Dim>(row_j, stencil_size<Dim> - 1 - k, g);
                 });
}

template <int Dim>
void G2PPressureGradient<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                          Read<particle::Configuration<Dim>> y_p, Read<node::Pressure> p_i,
                                          Write<particle::PressureGradient<Dim>> grad_p_p) const {
  for_each_cell<Dim>(*cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      Vec<Dim> gradient = Vec<Dim>::Zero();
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) {
        gradient += p_i[support.node[k]] * weights.gradient(offset);
      });
      grad_p_p[p] = gradient;
    }
  });
}

template <int Dim>
void P2GPressureGradient<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                          Read<particle::Configuration<Dim>> y_p, Read<particle::Mass> m_p,
                                          Read<particle::PressureGradient<Dim>> grad_p_p, Read<node::Mass> m_i,
                                          Write<node::PressureGradient<Dim>> g_i) const {
  scatter_constant<Dim>({*grid, *cells, y_p.span(), m_p.span(), m_i.span()}, grad_p_p.span(), g_i.span());
}

template struct StabilizePspg<2>;
template struct StabilizePspg<3>;
template struct StabilizeOss<2>;
template struct StabilizeOss<3>;
template struct G2PPressureGradient<2>;
template struct G2PPressureGradient<3>;
template struct P2GPressureGradient<2>;
template struct P2GPressureGradient<3>;

}  // namespace minamo
