#include "systems/transfer/carry_gradient.hpp"

#include "systems/grid/lanes.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// |tau grad v| up to which a gradient is carried all the way, and from which on not at all: a grid that sees so much
/// strain in half a step does not resolve it, and what converges would grow without bound.
constexpr double resolved = 0.05;
constexpr double unresolved = 0.1;

/// A matrix in every lane.
template <int Dim>
using LaneMatrix = std::array<std::array<Four, static_cast<std::size_t>(Dim)>, static_cast<std::size_t>(Dim)>;

/// Adjugate of A, A adj(A) = det(A) I.
template <int Dim>
[[gnu::always_inline]] inline LaneMatrix<Dim> adjugate(const LaneMatrix<Dim>& a) {
  if constexpr (Dim == 2) {
    return {{{a[1][1], -a[0][1]}, {-a[1][0], a[0][0]}}};
  } else {
    LaneMatrix<3> adj;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t i1 = (j + 1) % 3, i2 = (j + 2) % 3, j1 = (i + 1) % 3, j2 = (i + 2) % 3;
        adj[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
      }
    }
    return adj;
  }
}

template <int Dim>
[[gnu::always_inline]] inline LaneMatrix<Dim> inverse(const LaneMatrix<Dim>& a) {
  LaneMatrix<Dim> inverse = adjugate<Dim>(a);
  Four determinant = a[0][0] * inverse[0][0];
  for (std::size_t k = 1; k < Dim; ++k) determinant += a[k][0] * inverse[0][k];
  const Four per_determinant = 1.0 / determinant;
  for (auto& row : inverse) {
    for (Four& entry : row) entry *= per_determinant;
  }
  return inverse;
}

/// grad v (I + s tau grad v)^-1, s the resolved share.
template <int Dim>
[[gnu::always_inline]] inline LaneMatrix<Dim> carried(double tau, const LaneMatrix<Dim>& grad_v) {
  Four square{};
  for (const auto& row : grad_v) {
    for (const Four& entry : row) square += entry * entry;
  }
  Four share;
  for (std::size_t lane = 0; lane < lanes; ++lane) share[lane] = resolved_share(tau * std::sqrt(square[lane]));
  LaneMatrix<Dim> growth;
  for (std::size_t i = 0; i < Dim; ++i) {
    for (std::size_t j = 0; j < Dim; ++j) growth[i][j] = share * tau * grad_v[i][j] + (i == j ? 1.0 : 0.0);
  }
  const LaneMatrix<Dim> shrink = inverse<Dim>(growth);
  LaneMatrix<Dim> product;
  for (std::size_t i = 0; i < Dim; ++i) {
    for (std::size_t j = 0; j < Dim; ++j) {
      product[i][j] = grad_v[i][0] * shrink[0][j];
      for (std::size_t k = 1; k < Dim; ++k) product[i][j] += grad_v[i][k] * shrink[k][j];
    }
  }
  return product;
}

template <int Dim>
void carry(double seconds, const OccupiedCells<Dim>& cells, std::span<const double> w_c, std::span<Mat<Dim>> grad_v_p) {
  for_each_cell<Dim>(cells, [&](std::size_t c, const auto& cell) {
    const double tau = seconds * w_c[c];
    if (tau == 0) return;
    for_each_group(cell, [&](const Group& group) {
      LaneMatrix<Dim> grad_v;
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
          grad_v[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
              of_group(group, [&](std::size_t p) { return grad_v_p[p](i, j); });
        }
      }
      const LaneMatrix<Dim> now = carried<Dim>(tau, grad_v);
      for_each_lane(group, [&](std::size_t lane, std::size_t p) {
        for (int i = 0; i < Dim; ++i) {
          for (int j = 0; j < Dim; ++j)
            grad_v_p[p](i, j) = now[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)][lane];
        }
      });
    });
  });
}

}  // namespace

double resolved_share(double strain) { return std::clamp((unresolved - strain) / (unresolved - resolved), 0.0, 1.0); }

template <int Dim>
void CarryGradient<Dim>::operator()(Read<Clock> clock, Read<OccupiedCells<Dim>> cells, Read<cell::LiquidIndicator> w_c,
                                    Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  carry<Dim>(0.5 * clock->step, *cells, w_c.span(), grad_v_p.span());
}

template <int Dim>
void CarryGradientByFaces<Dim>::operator()(Read<Clock> clock, Read<GridCells<Dim>> cells,
                                           Read<cell::LiquidIndicator> w_c,
                                           Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  carry<Dim>(clock->step, *cells, w_c.span(), grad_v_p.span());
}

template struct CarryGradientByFaces<2>;
template struct CarryGradientByFaces<3>;
template struct CarryGradient<2>;
template struct CarryGradient<3>;

}  // namespace minamo
