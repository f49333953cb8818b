#include "systems/transfer/carry_gradient.hpp"

#include "systems/grid/support.hpp"

#include <Eigen/LU>

namespace minamo {

namespace {

/// Largest |tau grad v|: beyond it a step turns or stretches the liquid by so much that the inverse is no small change.
constexpr double most = 0.3;

template <int Dim>
Mat<Dim> carried(double tau, const Mat<Dim>& grad_v) {
  Mat<Dim> change = tau * grad_v;
  const double size = change.norm();
  if (size > most) change *= most / size;
  return grad_v * (Mat<Dim>::Identity() + change).inverse();
}

template <int Dim>
void carry_half_a_step(double dt, const OccupiedCells<Dim>& cells, const LiquidShare& liquid,
                       std::span<Mat<Dim>> grad_v_p) {
  for_each_cell<Dim>(cells, [&](std::size_t c, const auto& cell) {
    const double tau = 0.5 * dt * liquid.of_cell[c];
    if (tau == 0) return;
    for (std::size_t p = cell.begin; p < cell.end; ++p) grad_v_p[p] = carried<Dim>(tau, grad_v_p[p]);
  });
}

}  // namespace

template <int Dim>
void CarryGradientToMiddle<Dim>::operator()(Read<Clock> clock, Read<OccupiedCells<Dim>> cells, Read<LiquidShare> liquid,
                                            Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  carry_half_a_step<Dim>(clock->step, *cells, *liquid, grad_v_p.span());
}

template <int Dim>
void CarryGradientToEnd<Dim>::operator()(Read<Clock> clock, Read<OccupiedCells<Dim>> cells, Read<LiquidShare> liquid,
                                         Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  carry_half_a_step<Dim>(clock->step, *cells, *liquid, grad_v_p.span());
}

template struct CarryGradientToMiddle<2>;
template struct CarryGradientToMiddle<3>;
template struct CarryGradientToEnd<2>;
template struct CarryGradientToEnd<3>;

}  // namespace minamo
