#pragma once
/// \file
/// What APIC's affine part C_p, (E45), has beside the gradient of the velocity: the part of a grid's angular momentum
/// that a scheme which carries the gradient would lose.
///
/// (E71)  C_p - grad v_p = sum_d T_d/(2 D_d) d_d^2 v (x) e_d, D_d = h^2/4 the second and T_d = h^3 (xi_d/4 - xi_d^3)
/// the third moment of the weights along an axis, h xi from the middle of the dual cell to the particle. Ours. In the
/// half cells at walls weights are linear: no second derivative, and both are the same.

#include "systems/grid/support.hpp"

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

}  // namespace minamo
