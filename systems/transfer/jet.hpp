#pragma once
/// \file
/// A vector field at a point, up to its second derivatives.

#include "components/types.hpp"

namespace minamo {

/// Second derivatives of a vector field, in the order xx xy yy, in 3-D xx xy xz yy yz zz.
template <int Dim>
using SecondDerivatives = Eigen::Matrix<double, Dim, Dim*(Dim + 1) / 2>;

/// Column of d_a^2 in SecondDerivatives.
template <int Dim>
constexpr int second_along(int a) {
  return a * Dim - a * (a - 1) / 2;
}

/// use(column, a, b) for the columns of SecondDerivatives.
template <int Dim, class Use>
[[gnu::always_inline]] inline void for_each_pair(const Use& use) {
  int column = 0;
  for (int a = 0; a < Dim; ++a) {
    for (int b = a; b < Dim; ++b) use(column++, a, b);
  }
}

/// Value and derivatives of a field q at a point.
template <int Dim>
struct Jet {
  Vec<Dim> value;                 ///< q
  Mat<Dim> gradient;              ///< row i: gradient of component i
  SecondDerivatives<Dim> second;  ///< on nodes zero across a wall in the half cell next to it
};

/// phi_p of (E65), how much of a velocity's second derivatives the grid resolves.
template <int Dim>
[[gnu::always_inline]] inline double resolved_curvature(const Mat<Dim>& gradient,
                                                        const SecondDerivatives<Dim>& curvature, double h) {
  double square = 0;
  for_each_pair<Dim>(
      [&](int column, int a, int b) { square += (a == b ? 1 : 2) * curvature.col(column).squaredNorm(); });
  const double of_gradient = gradient.squaredNorm();
  const double sum = of_gradient + h * h * square;
  return sum > 0 ? of_gradient / sum : 0;
}

}  // namespace minamo
