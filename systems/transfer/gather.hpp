#pragma once
/// \file
/// The grid-to-particle kernels that transfer schemes are made of.

#include "components/particle.hpp"
#include "systems/grid/support.hpp"

#include <span>

namespace minamo {

/// Value and gradient of a nodal field at a particle.
template <int Dim>
struct Sample {
  Vec<Dim> value;
  Mat<Dim> gradient;  ///< row i: gradient of component i
};

/// sum_I S_Ip q_I and sum_I q_I (x) slope_Ip, direction by direction: half the work of a sum over nodes. Inline, or a
/// third of the time goes into passing numbers through memory.
template <int Dim>
[[gnu::always_inline]] inline Sample<Dim> interpolate(const Weights<Dim>& weights,
                                                      const std::array<Vec<Dim>, support_size<Dim>>& q) {
  const auto& [w, s] = weights;
  Sample<Dim> sample{Vec<Dim>::Zero(), Mat<Dim>::Zero()};
  for (std::size_t c = 0; c < (Dim == 3 ? 3 : 1); ++c) {
    Vec<Dim> value = Vec<Dim>::Zero();
    Vec<Dim> slope_x = Vec<Dim>::Zero();
    Vec<Dim> slope_y = Vec<Dim>::Zero();
    for (std::size_t b = 0; b < 3; ++b) {
      const Vec<Dim>* row = q.data() + 9 * c + 3 * b;
      const Vec<Dim> of_row = w[0][0] * row[0] + w[0][1] * row[1] + w[0][2] * row[2];
      value += w[1][b] * of_row;
      slope_x += w[1][b] * (s[0][0] * row[0] + s[0][1] * row[1] + s[0][2] * row[2]);
      slope_y += s[1][b] * of_row;
    }
    double w_z = 1;
    if constexpr (Dim == 3) {
      w_z = w[2][c];
      sample.gradient.col(2) += s[2][c] * value;
    }
    sample.value += w_z * value;
    sample.gradient.col(0) += w_z * slope_x;
    sample.gradient.col(1) += w_z * slope_y;
  }
  return sample;
}

/// (E17)  q_p = sum_I S_Ip q_I; use(p, q_p) for every particle. The nodal field is a function of the node's row.
template <int Dim, class AtNode, class Use>
void gather(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
            const AtNode& at_node, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(grid, cell);
    std::array<Vec<Dim>, support_size<Dim>> q;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = at_node(support.node[k]);
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      Vec<Dim> q_p = Vec<Dim>::Zero();
      for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { q_p += weights(offset) * q[k]; });
      use(p, q_p);
    }
  });
}

template <int Dim, class Use>
void gather(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
            std::span<const Vec<Dim>> q_i, const Use& use) {
  gather<Dim>(
      grid, cells, y_p, [&](std::size_t i) -> const Vec<Dim>& { return q_i[i]; }, use);
}

/// The nodal field on a support.
template <int Dim>
std::array<Vec<Dim>, support_size<Dim>> on_support(const Support<Dim>& support, std::span<const Vec<Dim>> q_i) {
  std::array<Vec<Dim>, support_size<Dim>> q;
  for (std::size_t k = 0; k < q.size(); ++k) q[k] = q_i[support.node[k]];
  return q;
}

/// The value as in (E17) and sum_I q_I (x) w_Ip, where w_Ip is what slope(support, weights) makes of the weights.
template <int Dim, class Slope, class Use>
void gather_value_and_slope(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                            std::span<const Vec<Dim>> q_i, const Slope& slope, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(grid, cell);
    const auto q = on_support<Dim>(support, q_i);
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      use(p, interpolate<Dim>(slope(support, Weights<Dim>(support, y_p[p]), y_p[p]), q));
    }
  });
}

/// (E17), (E18)  with grad q_p = sum_I q_I (x) grad S_Ip; use(p, sample) for every particle.
template <int Dim, class Use>
void gather_with_gradient(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                          std::span<const Vec<Dim>> q_i, const Use& use) {
  const auto keep = [](const Support<Dim>&, const Weights<Dim>& weights, const Vec<Dim>&) { return weights; };
  gather_value_and_slope<Dim>(grid, cells, y_p, q_i, keep, use);
}

/// S_Ip D_p^-1 (x_I - y_p) in the place of the slopes.
template <int Dim>
[[gnu::always_inline]] inline Weights<Dim> affine_weights(const Support<Dim>& support, Weights<Dim> weights,
                                                          const Vec<Dim>& y) {
  for (std::size_t d = 0; d < Dim; ++d) {
    // In the half cell at a wall w_a (x_a - y)/D is the slope itself, and does not divide by a vanishing D.
    if (support.basis[d] != &inner_basis) continue;
    const auto axis = static_cast<Eigen::Index>(d);
    const double xi = (y[axis] - support.centre[axis]) * support.per_spacing;
    for (std::size_t a = 0; a < 3; ++a) {
      weights.slope[d][a] = 4 * support.per_spacing * weights.value[d][a] * (static_cast<double>(a) - 1 - xi);
    }
  }
  return weights;
}

/// (E17), (E45)  with C_p = sum_I S_Ip q_I (x) D_p^-1 (x_I - y_p) in the place of the gradient.
template <int Dim, class Use>
void gather_with_affine(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                        std::span<const Vec<Dim>> q_i, const Use& use) {
  gather_value_and_slope<Dim>(grid, cells, y_p, q_i, affine_weights<Dim>, use);
}

}  // namespace minamo
