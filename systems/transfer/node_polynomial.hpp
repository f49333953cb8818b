#pragma once
/// \file
/// A nodal field within a dual cell as a polynomial, where weights are quadratic along every axis: a few numbers per
/// cell, after which value and derivatives at a particle cost less than its weights.

#include "systems/grid/node_support.hpp"
#include "systems/transfer/jet.hpp"
#include "systems/transfer/padded.hpp"

namespace minamo {

/// (E17), (E18)  q(y) = sum_I S_I(y) q_I and its derivatives, y in the dual cell of a support.
template <int Dim>
class CellPolynomial {
 public:
  /// at_node(row) is q_I.
  template <class AtNode>
  CellPolynomial(const Support<Dim>& support, const AtNode& at_node) : CellPolynomial(support, support.node, at_node) {}
  /// The same where `node` says in other words which nodes they are.
  template <class Nodes, class AtNode>
  CellPolynomial(const SupportBox<Dim>& box, const Nodes& node, const AtNode& at_node)
      : centre_(box.centre), per_spacing_(box.per_spacing) {
    for (std::size_t k = 0; k < c_.size(); ++k) c_[k] = padded<Dim>(at_node(node[k]));
    along_axis<0>(*box.basis[0]);
    along_axis<1>(*box.basis[1]);
    if constexpr (Dim == 3) along_axis<2>(*box.basis[2]);
  }

  /// The point in units of h, from the cell's own node.
  Vec<Dim> local(const Vec<Dim>& y) const { return (y - centre_) * per_spacing_; }

  /// Inline, so that what the caller does not use is not computed.
  [[gnu::always_inline]] Jet<Dim> at(const Vec<Dim>& xi) const {
    Jet<Dim> jet;
    const auto value_of = [](const PaddedVec<Dim>& v) { return unpadded<Dim>(v); };
    const auto once = [&](const PaddedVec<Dim>& v) { return unpadded<Dim>(per_spacing_ * v); };
    const auto twice = [&](const PaddedVec<Dim>& v) { return unpadded<Dim>(per_spacing_ * per_spacing_ * v); };
    if constexpr (Dim == 2) {
      const auto [value, slope, bend] = plane(c_.data(), xi);
      jet.value = value_of(value.value);
      jet.gradient << once(slope.value), once(value.first);
      jet.second << twice(bend.value), twice(slope.first), twice(value.second);
    } else {
      const Plane p[] = {plane(c_.data(), xi), plane(c_.data() + 9, xi), plane(c_.data() + 18, xi)};
      const auto along_z = [&](const auto& of) { return Line(of(p[0]), of(p[1]), of(p[2]), xi[2]); };
      const Line value = along_z([](const Plane& of) { return of.value.value; });
      const Line slope_x = along_z([](const Plane& of) { return of.slope.value; });
      const Line slope_y = along_z([](const Plane& of) { return of.value.first; });
      const Line bend_x = along_z([](const Plane& of) { return of.bend.value; });
      const Line bend_y = along_z([](const Plane& of) { return of.value.second; });
      const Line twist = along_z([](const Plane& of) { return of.slope.first; });
      jet.value = value_of(value.value);
      jet.gradient << once(slope_x.value), once(slope_y.value), once(value.first);
      jet.second << twice(bend_x.value), twice(twist.value), twice(slope_x.first), twice(bend_y.value),
          twice(slope_y.first), twice(value.second);
    }
    return jet;
  }

 private:
  /// From values at the three nodes of every line along an axis to coefficients of powers.
  template <int Axis>
  void along_axis(const AxisBasis& basis) {
    constexpr std::size_t stride = power(3, Axis);
    for (std::size_t line = 0; line < support_size<Dim> / 3; ++line) {
      PaddedVec<Dim>* node = c_.data() + line % stride + line / stride * 3 * stride;
      const auto coefficient = [&](std::size_t k) -> PaddedVec<Dim> {
        return basis.weight[0][k] * node[0] + basis.weight[1][k] * node[stride] + basis.weight[2][k] * node[2 * stride];
      };
      const PaddedVec<Dim> constant = coefficient(0);
      const PaddedVec<Dim> linear = coefficient(1);
      node[2 * stride] = coefficient(2);
      node[stride] = linear;
      node[0] = constant;
    }
  }

  /// Value and derivatives of c0 + c1 x + c2 x^2.
  struct Line {
    PaddedVec<Dim> value, first, second;
    [[gnu::always_inline]] Line(const PaddedVec<Dim>& c0, const PaddedVec<Dim>& c1, const PaddedVec<Dim>& c2, double x)
        : value(c0 + x * (c1 + x * c2)), first(c1 + (2 * x) * c2), second(2 * c2) {}
  };
  /// Along y: of the value, of the first and of the second derivative along x.
  struct Plane {
    Line value, slope, bend;
  };

  [[gnu::always_inline]] static Plane plane(const PaddedVec<Dim>* c, const Vec<Dim>& xi) {
    const Line x[] = {{c[0], c[1], c[2], xi[0]}, {c[3], c[4], c[5], xi[0]}, {c[6], c[7], c[8], xi[0]}};
    return {{x[0].value, x[1].value, x[2].value, xi[1]},
            {x[0].first, x[1].first, x[2].first, xi[1]},
            {x[0].second, x[1].second, x[2].second, xi[1]}};
  }

  std::array<PaddedVec<Dim>, support_size<Dim>> c_;  ///< of xi^a eta^b zeta^c at a + 3 b + 9 c
  Vec<Dim> centre_;
  double per_spacing_;
};

}  // namespace minamo
