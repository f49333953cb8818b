#include "systems/equal_order/inertia.hpp"

#include "systems/equal_order/moments.hpp"
#include "systems/grid/activate.hpp"
#include "systems/grid/constraint.hpp"

namespace minamo {

namespace {

/// The factors of a product of weights, with `special` in direction d.
template <int Dim>
NodeFactors<Dim> node_factors(const Support<Dim>& support, int d, AxisBasis::NodeProducts AxisBasis::*special) {
  NodeFactors<Dim> factors;
  for (std::size_t axis = 0; axis < factors.size(); ++axis) {
    const AxisBasis& basis = *support.basis[axis];
    factors[axis] = static_cast<int>(axis) == d ? &(basis.*special) : &basis.of_weight;
  }
  return factors;
}

template <int Dim>
Mat<Dim> mean(const typename OccupiedCells<Dim>::Cell& cell, std::span<const double> m_p,
              std::span<const Mat<Dim>> q_p) {
  double mass = 0;
  Mat<Dim> sum = Mat<Dim>::Zero();
  for (std::size_t p = cell.begin; p < cell.end; ++p) {
    mass += m_p[p];
    sum += m_p[p] * q_p[p];
  }
  return sum / mass;
}

/// m_I c_I of (E53).
template <int Dim>
void scatter_first_moment(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const double> rho_c,
                          const Moments<Dim>& moments, std::span<const double> m_p, std::span<const Mat<Dim>> grad_f_p,
                          std::span<const double> w_c, std::span<Vec<Dim>> out) {
  for_each_row(out.size(), [&](std::size_t i) { out[i].setZero(); });
  for_each_cell_coloured<Dim>(cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(grid, cell);
    const double share = w_c[c];
    if (share == 0) return;
    const Mat<Dim> gradient = share * rho_c[c] * grid.spacing * mean<Dim>(cell, m_p, grad_f_p);
    for (int d = 0; d < Dim; ++d) {
      const auto way = cell_vector<Dim>(moments.of_cell[c], node_factors<Dim>(support, d, &AxisBasis::of_distance));
      for (std::size_t k = 0; k < way.size(); ++k) out[support.node[k]] += way[k] * gradient.col(d);
    }
  });
}

}  // namespace

template <int Dim>
void AddInertiaCorrection<Dim>::operator()(Read<Clock> clock, Read<ForceStep> step, Read<Grid<Dim>> grid,
                                           Read<OccupiedCells<Dim>> cells, Read<cell::Density> rho_c,
                                           Read<Moments<Dim>> moments, Read<cell::LiquidIndicator> w_c,
                                           Read<particle::Mass> m_p, Read<particle::ForceGradient<Dim>> grad_f_p,
                                           Read<node::Row> row, Read<node::Constraint> constraint,
                                           Optional<Read<node::ConstraintFrame<Dim>>> frame, Read<node::Mass> m_i,
                                           Read<matrix::Node> node, Write<node::InertiaCorrection<Dim>> c_i,
                                           Update<matrix::Momentum<Dim>> f) const {
  scatter_first_moment<Dim>(*grid, *cells, rho_c.span(), *moments, m_p.span(), grad_f_p.span(), w_c.span(), c_i.span());
  const double share = std::min(1.0, step->seconds / clock->step);
  const double threshold = mass_threshold(m_i.span());
  const Constraints<Dim> constraints{constraint.span(), frame.span()};
  for_each_row(c_i.size(), [&](std::size_t i) {
    // What the liquid does to a node below the threshold next to a wall is not to come back to it as inertia of its
    // own.
    if (row[i] < 0 || m_i[i] <= threshold) {
      c_i[i].setZero();
    } else {
      c_i[i] *= share / m_i[i];
      hold_at_rest<Dim>(constraints, i, c_i[i]);
    }
  });
  for_each_row(node.size(), [&](std::size_t r) {
    const std::uint32_t i = node[r];
    f[r] += m_i[i] * c_i[i];
  });
}

template <int Dim>
void G2PForceGradient<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                       Read<Moments<Dim>> moments, Read<node::Velocity<Dim>> v_old,
                                       Read<node::NewVelocity<Dim>> v_new, Read<node::InertiaCorrection<Dim>> c_i,
                                       Write<particle::ForceGradient<Dim>> grad_f_p, Write<ForceStep> step) const {
  step->seconds = clock->step;
  const double per_step = 1 / clock->step;
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    Mat<Dim> gradient = Mat<Dim>::Zero();
    for (int d = 0; d < Dim; ++d) {
      const auto slope = cell_vector<Dim>(moments->of_cell[c], node_factors<Dim>(support, d, &AxisBasis::of_slope));
      for (std::size_t k = 0; k < slope.size(); ++k) {
        const std::size_t j = support.node[k];
        gradient.col(d) += slope[k] * (per_step * (v_new[j] - v_old[j]) - c_i[j]);
      }
    }
    gradient *= support.per_spacing / moments->of_cell[c][0];
    for (std::size_t p = cell.begin; p < cell.end; ++p) grad_f_p[p] = gradient;
  });
}

template struct AddInertiaCorrection<2>;
template struct AddInertiaCorrection<3>;
template struct G2PForceGradient<2>;
template struct G2PForceGradient<3>;

}  // namespace minamo
