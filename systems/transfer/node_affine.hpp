#pragma once
/// \file
/// APIC's affine part of a nodal field, C_p of (E45), from its gradient and second derivatives; and what it has in
/// addition to the gradient: the part of a grid's angular momentum that a scheme which carries the gradient would lose.
///
/// (E71)  C_p - grad v_p = sum_d T_d/(2 D_d) d_d^2 v (x) e_d, D_d = h^2/4 the second and T_d = h^3 (xi_d/4 - xi_d^3)
/// the third moment of the weights along an axis, h xi from the middle of the dual cell to the particle. Ours. In the
/// half cells at walls weights are linear: no second derivative, and both are the same.

#include "systems/transfer/node_gather.hpp"

namespace minamo {

/// C_p - grad v_p from the second derivatives at xi. [1/s]
template <int Dim>
[[gnu::always_inline]] inline Mat<Dim> beyond_gradient(const SecondDerivatives<Dim>& second, const Vec<Dim>& xi,
                                                       double h) {
  const Vec<Dim> moment = h * (xi.array() * (0.5 - 2 * xi.array().square())).matrix();  // T_d/(2 D_d) [m]
  Mat<Dim> beyond;
  for (int d = 0; d < Dim; ++d) beyond.col(d) = moment[d] * second.col(second_along<Dim>(d));
  return beyond;
}

template <int Dim>
Mat<Dim> antisymmetric(const Mat<Dim>& of) {
  return 0.5 * (of - of.transpose());
}

/// (E17), (E18), (E71)  use(cell, p, jet, C_p - gradient) for every particle.
template <int Dim, class Use>
void gather_with_affine(const NodeTarget<Dim>& target, std::span<const Vec<Dim>> q_i, const Use& use) {
  for_each_cell<Dim>(target.cells, [&](std::size_t c, const auto& cell) {
    const CellPolynomial<Dim> q(Support<Dim>(target.grid, cell), of_nodes<Dim>(q_i));
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      const Vec<Dim> xi = q.local(target.y_p[p]);
      const Jet<Dim> jet = q.at(xi);
      use(c, p, jet, beyond_gradient<Dim>(jet.second, xi, target.grid.spacing));
    }
  });
}

}  // namespace minamo
