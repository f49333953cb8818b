#pragma once
/// \file
/// What APIC's affine part C_p, (E45), has beside the gradient of the velocity: the part of a grid's angular momentum
/// that a scheme which carries the gradient would lose.
///
/// (E71)  C_p - grad v_p = sum_d T_d/(2 D_d) d_d^2 v (x) e_d, D_d = h^2/4 the second and T_d = h^3 (xi_d/4 - xi_d^3)
/// the third moment of the weights along an axis, h xi from the middle of the dual cell to the particle. Ours. In the
/// half cells at walls weights are linear: no second derivative, and both are the same.

#include "systems/transfer/gather.hpp"

namespace minamo {

/// T_d/(2 D_d) of (E71), out of half cells at walls. [m]
template <int Dim>
[[gnu::always_inline]] inline Vec<Dim> third_moments(const Support<Dim>& support, const Vec<Dim>& y) {
  const Vec<Dim> xi = (y - support.centre) * support.per_spacing;
  return xi.array() * (0.5 - 2 * xi.array().square()) / support.per_spacing;
}

template <int Dim>
Mat<Dim> antisymmetric(const Mat<Dim>& of) {
  return 0.5 * (of - of.transpose());
}

/// Second derivatives along the axes of a nodal field within a dual cell, where those of the weights are constant; zero
/// across a wall in the half cells beside it.
template <int Dim>
class Bends {
 public:
  Bends(const Support<Dim>& support, const std::array<Vec<Dim>, support_size<Dim>>& q) {
    for_each_axis([&](std::size_t d, std::size_t step, std::size_t low, std::size_t high) {
      const double scale = support.basis[d] == &inner_basis ? support.per_spacing * support.per_spacing : 0;
      for (std::size_t line = 0; line < lines; ++line) {
        const Vec<Dim>* node = q.data() + low * (line % 3) + high * (line / 3);
        bend_[d][line] = scale * (node[0] - 2 * node[step] + node[2 * step]);
      }
    });
  }

  /// Column d: d_d^2 q at a particle.
  [[gnu::always_inline]] Mat<Dim> at(const Weights<Dim>& weights) const {
    const auto& w = weights.value;
    Mat<Dim> second;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t low = d == 0 ? 1 : 0;
      const std::size_t high = d == 2 ? 1 : 2;
      Vec<Dim> sum = Vec<Dim>::Zero();
      for (std::size_t b = 0; b < lines / 3; ++b) {
        const Vec<Dim>* of = bend_[d].data() + 3 * b;
        const Vec<Dim> along = w[low][0] * of[0] + w[low][1] * of[1] + w[low][2] * of[2];
        if constexpr (Dim == 3) {
          sum += w[high][b] * along;
        } else {
          sum += along;
        }
      }
      second.col(static_cast<Eigen::Index>(d)) = sum;
    }
    return second;
  }

 private:
  static constexpr std::size_t lines = support_size<Dim> / 3;  ///< of three nodes along an axis

  /// use(axis, and how far nodes are apart in the order of a support: along it, along the two others).
  template <class Use>
  static void for_each_axis(const Use& use) {
    use(0, 1, 3, 9);
    use(1, 3, 1, 9);
    if constexpr (Dim == 3) use(2, 9, 1, 3);
  }

  std::array<std::array<Vec<Dim>, lines>, Dim> bend_;
};

/// A nodal field at a particle.
template <int Dim>
struct Bent {
  const Weights<Dim>& weights;
  const std::array<Vec<Dim>, support_size<Dim>>& q;  ///< on the particle's support
  Sample<Dim> sample;
  Mat<Dim> second;  ///< column d: d_d^2 q
  Mat<Dim> beyond;  ///< C_p - grad q_p, (E71)
};

/// (E17), (E18), (E71)  use(cell, p, bent) for every particle.
template <int Dim, class Use>
void gather_bent(const Grid<Dim>& grid, const OccupiedCells<Dim>& cells, std::span<const Vec<Dim>> y_p,
                 std::span<const Vec<Dim>> q_i, const Use& use) {
  for_each_cell<Dim>(cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(grid, cell);
    const auto q = on_support<Dim>(support, q_i);
    const Bends<Dim> bends(support, q);
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Weights<Dim> weights(support, y_p[p]);
      const Mat<Dim> second = bends.at(weights);
      const Mat<Dim> beyond = second * third_moments<Dim>(support, y_p[p]).asDiagonal();
      use(c, p, Bent<Dim>{weights, q, interpolate<Dim>(weights, q), second, beyond});
    }
  });
}

}  // namespace minamo
