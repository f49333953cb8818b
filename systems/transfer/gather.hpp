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

/// Slopes, or what stands in their place, per direction and node along it. [1/m]
template <int Dim>
using Slopes = decltype(Weights<Dim>::slope);

/// Value of a nodal field at a particle, and as many gradients as there are kinds of slopes.
template <int Dim, std::size_t Kinds>
struct Samples {
  Vec<Dim> value = Vec<Dim>::Zero();
  std::array<Mat<Dim>, Kinds> gradient;
};

/// sum_I S_Ip q_I and sum_I q_I (x) slope_Ip, direction by direction: half the work of a sum over nodes. Inline, or a
/// third of the time goes into passing numbers through memory.
template <int Dim, std::size_t Kinds>
[[gnu::always_inline]] inline Samples<Dim, Kinds> interpolate(const Weights<Dim>& weights,
                                                              const std::array<const Slopes<Dim>*, Kinds>& slopes,
                                                              const std::array<Vec<Dim>, support_size<Dim>>& q) {
  const auto& w = weights.value;
  Samples<Dim, Kinds> sample;
  for (Mat<Dim>& gradient : sample.gradient) gradient.setZero();
  for (std::size_t c = 0; c < (Dim == 3 ? 3 : 1); ++c) {
    Vec<Dim> value = Vec<Dim>::Zero();
    std::array<Vec<Dim>, Kinds> slope_x;
    std::array<Vec<Dim>, Kinds> slope_y;
    slope_x.fill(Vec<Dim>::Zero());
    slope_y.fill(Vec<Dim>::Zero());
    for (std::size_t b = 0; b < 3; ++b) {
      const Vec<Dim>* row = q.data() + 9 * c + 3 * b;
      const Vec<Dim> of_row = w[0][0] * row[0] + w[0][1] * row[1] + w[0][2] * row[2];
      value += w[1][b] * of_row;
      for (std::size_t k = 0; k < Kinds; ++k) {
        const auto& s = *slopes[k];
        slope_x[k] += w[1][b] * (s[0][0] * row[0] + s[0][1] * row[1] + s[0][2] * row[2]);
        slope_y[k] += s[1][b] * of_row;
      }
    }
    double w_z = 1;
    if constexpr (Dim == 3) w_z = w[2][c];
    sample.value += w_z * value;
    for (std::size_t k = 0; k < Kinds; ++k) {
      if constexpr (Dim == 3) sample.gradient[k].col(2) += (*slopes[k])[2][c] * value;
      sample.gradient[k].col(0) += w_z * slope_x[k];
      sample.gradient[k].col(1) += w_z * slope_y[k];
    }
  }
  return sample;
}

template <int Dim>
Sample<Dim> interpolate(const Weights<Dim>& weights, const std::array<Vec<Dim>, support_size<Dim>>& q) {
  const auto sample = interpolate<Dim, 1>(weights, {&weights.slope}, q);
  return {sample.value, sample.gradient[0]};
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

/// body(p, support, the nodal field on it) for every particle.
template <int Dim, class Body>
void for_each_supported(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> q_i,
                        const Body& body) {
  for_each_cell<Dim>(cells, [&](std::size_t, const auto& cell) {
    const Support<Dim> support(grid, cell);
    std::array<Vec<Dim>, support_size<Dim>> q;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = q_i[support.node[k]];
    for (std::size_t p = cell.begin; p < cell.end; ++p) body(p, support, q);
  });
}

/// The value as in (E17) and sum_I q_I (x) w_Ip, where w_Ip is what slope(support, weights) makes of the weights.
template <int Dim, class Slope, class Use>
void gather_value_and_slope(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                            std::span<const Vec<Dim>> q_i, const Slope& slope, const Use& use) {
  for_each_supported<Dim>(grid, cells, q_i, [&](std::size_t p, const auto& support, const auto& q) {
    use(p, interpolate<Dim>(slope(support, Weights<Dim>(support, y_p[p]), y_p[p]), q));
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

/// (E17), (E71)  the gradient with the antisymmetric part of C_p, (E45), in the place of its own.
template <int Dim>
[[gnu::always_inline]] inline Sample<Dim> interpolate_with_spin(const Support<Dim>& support,
                                                                const Weights<Dim>& weights, const Vec<Dim>& y,
                                                                const std::array<Vec<Dim>, support_size<Dim>>& q) {
  const Weights<Dim> affine = affine_weights<Dim>(support, weights, y);
  const auto sample = interpolate<Dim, 2>(weights, {&weights.slope, &affine.slope}, q);
  const Mat<Dim> more = sample.gradient[1] - sample.gradient[0];
  return {sample.value, sample.gradient[0] + 0.5 * (more - more.transpose())};
}

}  // namespace minamo
