#include "systems/time/midpoint.hpp"

#include "engine/schedule/parallel.hpp"

namespace minamo {

template <int Dim>
void PredictMidpoint<Dim>::operator()(Read<Clock> clock, Read<node::Velocity<Dim>> v_i, Write<Rates> rates,
                                      Write<node::PredictedVelocity<Dim>> v_predicted,
                                      Write<node::PredictedAcceleration<Dim>> a_predicted) const {
  const double dt = clock->step;
  *rates = midpoint_rates(*clock);
  for_each_row(v_i.size(), [&](std::size_t i) {
    v_predicted[i].setZero();
    a_predicted[i] = -2 / dt * v_i[i];
  });
}

template <int Dim>
void CorrectMidpoint<Dim>::operator()(Read<Clock> clock, Read<node::Displacement<Dim>> u_i,
                                      Read<node::Velocity<Dim>> v_i, Write<node::NewVelocity<Dim>> v_new) const {
  const double per_half_step = 2 / clock->step;
  for_each_row(u_i.size(), [&](std::size_t i) { v_new[i] = per_half_step * u_i[i] - v_i[i]; });
}

template struct PredictMidpoint<2>;
template struct PredictMidpoint<3>;
template struct CorrectMidpoint<2>;
template struct CorrectMidpoint<3>;

}  // namespace minamo
