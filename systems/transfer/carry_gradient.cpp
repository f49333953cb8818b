#include "systems/transfer/carry_gradient.hpp"

#include "systems/grid/node_support.hpp"

#include <Eigen/LU>

namespace minamo {

namespace {

/// |tau grad v| up to which a gradient is carried all the way, and from which on not at all: a grid that sees so much
/// strain in half a step does not resolve it, and what converges would grow without bound.
constexpr double resolved = 0.05;
constexpr double unresolved = 0.1;

template <int Dim>
Mat<Dim> carried(double tau, const Mat<Dim>& grad_v) {
  const double share = resolved_share(tau * grad_v.norm());
  if (share == 0) return grad_v;
  return grad_v * (Mat<Dim>::Identity() + share * tau * grad_v).inverse();
}

template <int Dim>
void carry(double seconds, const OccupiedCells<Dim>& cells, std::span<const double> w_c, std::span<Mat<Dim>> grad_v_p) {
  for_each_cell<Dim>(cells, [&](std::size_t c, const auto& cell) {
    const double tau = seconds * w_c[c];
    if (tau == 0) return;
    for (std::size_t p = cell.begin; p < cell.end; ++p) grad_v_p[p] = carried<Dim>(tau, grad_v_p[p]);
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
