#include "systems/equal_order/right_hand_side.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/constraint.hpp"
#include "systems/grid/node_neighbours.hpp"

namespace minamo {

namespace {

template <int Dim>
struct RightHandSideTerms {
  double c_v;
  Constraints<Dim> constraints;
  std::span<const double> m_i;
  std::span<const Vec<Dim>> b_i;
  std::span<const Vec<Dim>> v_predicted;
  std::span<const Vec<Dim>> a_predicted;
  std::span<const Vec<Dim>> u_i;
  std::span<const std::uint32_t> node;
  std::span<const typename matrix::Neighbour<Dim>::value_type> neighbour;
  std::span<const typename matrix::Divergence<Dim>::value_type> divergence;
  std::span<const double> source;
  std::span<const typename matrix::Viscosity<Dim>::value_type> viscosity;  ///< empty if inviscid
};

/// Right-hand sides of (E25) and (E26) for one row.
template <int Dim>
void fill_row(const RightHandSideTerms<Dim>& t, std::size_t r, Vec<Dim>& f, double& g) {
  const std::uint32_t i = t.node[r];
  Vec<Dim> momentum = t.m_i[i] * (t.b_i[i] - t.a_predicted[i]);
  double mass = t.source[r];
  for_each_neighbour<Dim>(t.neighbour[r], [&](std::size_t to_j, std::uint32_t j) {
    const Vec<Dim> v = t.v_predicted[j] + t.c_v * t.u_i[j];
    if (v.isZero(0)) return;
    for (std::size_t d = 0; d < Dim; ++d) {
      mass -= t.divergence[r][Dim * to_j + d] * v[static_cast<Eigen::Index>(d)];
      if (t.viscosity.empty()) continue;
      for (std::size_t e = 0; e < Dim; ++e) {
        momentum[static_cast<Eigen::Index>(e)] -=
            t.viscosity[r][Dim * (Dim * to_j + e) + d] * v[static_cast<Eigen::Index>(d)];
      }
    }
  });
  hold_at_rest<Dim>(t.constraints, i, momentum);
  f = momentum;
  g = mass;
}

template <int Dim>
void fill(const RightHandSideTerms<Dim>& terms, std::span<Vec<Dim>> f, std::span<double> g) {
  constexpr std::size_t rows_per_task = 256;
  for_each_row(
      terms.node.size(), [&](std::size_t r) { fill_row<Dim>(terms, r, f[r], g[r]); }, rows_per_task);
}

}  // namespace

template <int Dim>
void FillRightHandSide<Dim>::operator()(
    Read<Rates> rates, Read<node::Constraint> constraint, Optional<Read<node::ConstraintFrame<Dim>>> frame,
    Read<node::Mass> m_i, Read<node::BodyForce<Dim>> b_i, Read<node::PredictedVelocity<Dim>> v_predicted,
    Read<node::PredictedAcceleration<Dim>> a_predicted, Read<node::Displacement<Dim>> u_i, Read<matrix::Node> node,
    Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
    Read<matrix::StabilizationSource> source, Optional<Read<matrix::Viscosity<Dim>>> viscosity,
    Write<matrix::Momentum<Dim>> f, Write<matrix::Mass> g) const {
  fill<Dim>({rates->velocity,
             {constraint.span(), frame.span()},
             m_i.span(),
             b_i.span(),
             v_predicted.span(),
             a_predicted.span(),
             u_i.span(),
             node.span(),
             neighbour.span(),
             divergence.span(),
             source.span(),
             viscosity.span()},
            f.span(), g.span());
}

template struct FillRightHandSide<2>;
template struct FillRightHandSide<3>;

}  // namespace minamo
