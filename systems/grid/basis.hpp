#pragma once
/// \file
/// Quadratic B-spline with kernel correction at walls, one axis at a time, as polynomials within a dual cell.
///
/// (E1)  S_I(x) = prod_d w_d, w(r) = 3/4 - r^2 for |r| <= 1/2, (3/2 - |r|)^2 / 2 for 1/2 <= |r| <= 3/2, r in units of
/// h. (E2)  In the half cell next to a wall: w = 1 - s on the wall node, s on its neighbour, s the distance to the
/// wall.
///
/// Kernel correction: Nakamura, Matsumura, Mizutani, CMAME 403 (2023) 115720, doi:10.1016/j.cma.2022.115720. They
/// restore sum S = 1 and sum S x_I = x by weighted least squares on the nodes that are left. On a box with a
/// multilinear correction that reduces to (E2), without a matrix per particle; tests/property/basis_test.cpp proves it.

#include "components/grid.hpp"

#include <algorithm>

namespace minamo {

/// Powers of the local coordinate in a weight (0, 1, 2), and in a product of two weights (0 ... 4).
inline constexpr std::size_t weight_powers = 3;
inline constexpr std::size_t product_powers = 5;
/// The nine pairs of nodes, and zeros up to a whole number of vectors.
inline constexpr std::size_t padded_pairs = 12;

/// The three weights of one axis within a dual cell: w_a(xi) = sum_k weight[a][k] xi^k, xi in units of h from the
/// cell's own node. Node a is node `first + a` of the axis, `first` relative to the cell's own node.
struct AxisBasis {
  int first;
  std::array<std::array<double, weight_powers>, 3> weight;
  std::array<std::array<double, 2>, 3> slope;  ///< dw_a/dxi
  /// Products of node a and node b at [3 a + b] of every power: w_a w_b, dw_a w_b, w_a dw_b, dw_a dw_b.
  using PairProducts = std::array<std::array<double, padded_pairs>, product_powers>;
  PairProducts weight_weight;
  PairProducts slope_weight;
  PairProducts weight_slope;
  PairProducts slope_slope;
  /// Of node a, by power: w_a, dw_a, and w_a times the way from the point to the node in units of h.
  using NodeProducts = std::array<std::array<double, product_powers>, 3>;
  NodeProducts of_weight;
  NodeProducts of_slope;
  NodeProducts of_distance;
  /// Integrals over the dual cell of w_a xi^k at [a][k], in units of h.
  NodeProducts integral;

  double value(std::size_t a, double xi) const { return weight[a][0] + xi * (weight[a][1] + xi * weight[a][2]); }
  double derivative(std::size_t a, double xi) const { return slope[a][0] + xi * slope[a][1]; }
};

/// In the dual cells on a low wall, on a high wall, and away from walls.
extern const AxisBasis low_wall_basis;
extern const AxisBasis high_wall_basis;
extern const AxisBasis inner_basis;

/// The basis of an axis in the dual cell of `node`, on an axis with nodes 0 ... `last` between walls.
inline const AxisBasis& axis_basis(int node, int last) {
  if (node == 0) return low_wall_basis;
  return node == last ? high_wall_basis : inner_basis;
}

/// Integral of a node's weight over its axis, in units of h: 13/24, 23/24, 1, ... from a wall.
inline double axis_integral(int node, int last) {
  const int from_wall = std::min(node, last - node);
  if (from_wall == 0) return 13. / 24;
  return from_wall == 1 ? 23. / 24 : 1;
}

template <int Dim>
const AxisBasis& axis_basis(const Grid<Dim>& grid, std::size_t axis, int node) {
  return grid.periodic[axis] ? inner_basis : axis_basis(node, grid.cells[axis]);
}

}  // namespace minamo
