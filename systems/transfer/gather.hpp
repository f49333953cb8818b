#pragma once
/// \file
/// The grid-to-particle kernels that transfer schemes are made of.

#include "components/particle.hpp"
#include "systems/transfer/cell_polynomial.hpp"

#include <span>

namespace minamo {

/// A nodal field as a function of the node's row.
template <int Dim>
auto of_nodes(std::span<const Vec<Dim>> q_i) {
  return [q_i](std::size_t i) -> const Vec<Dim>& { return q_i[i]; };
}

/// (E17)  q_p = sum_I S_Ip q_I; use(p, q_p) for every particle. The nodal field is a function of the node's row.
template <int Dim, class AtNode, class Use>
void gather(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
            const AtNode& at_node, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const CellPolynomial<Dim> q(Support<Dim>(grid, cell), at_node);
    for (std::size_t p = cell.begin; p < cell.end; ++p) use(p, q.at(q.local(y_p[p])).value);
  });
}

template <int Dim, class Use>
void gather(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
            std::span<const Vec<Dim>> q_i, const Use& use) {
  gather<Dim>(grid, cells, y_p, of_nodes<Dim>(q_i), use);
}

/// (E17), (E18)  use(p, jet of the nodal field) for every particle.
template <int Dim, class Use>
void gather_with_gradient(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                          std::span<const Vec<Dim>> q_i, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const CellPolynomial<Dim> q(Support<Dim>(grid, cell), of_nodes<Dim>(q_i));
    for (std::size_t p = cell.begin; p < cell.end; ++p) use(p, q.at(q.local(y_p[p])));
  });
}

/// Value and affine part of a nodal field at a particle.
template <int Dim>
struct Sample {
  Vec<Dim> value;
  Mat<Dim> gradient;  ///< row i: of component i
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
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(grid, cell);
    std::array<Vec<Dim>, support_size<Dim>> q;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = q_i[support.node[k]];
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const auto weights = affine_weights<Dim>(support, Weights<Dim>(support, y_p[p]), y_p[p]);
      use(p, interpolate<Dim>(weights, q));
    }
  });
}

}  // namespace minamo
