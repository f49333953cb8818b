#include "systems/time/newmark.hpp"

#include "engine/schedule/parallel.hpp"

namespace minamo {

template <int Dim>
void PredictNewmark<Dim>::operator()(Read<Clock> clock, Read<NewmarkParameters> newmark, Read<node::Velocity<Dim>> v_i,
                                     Read<node::Acceleration<Dim>> a_i, Write<Rates> rates,
                                     Write<node::PredictedVelocity<Dim>> v_predicted,
                                     Write<node::PredictedAcceleration<Dim>> a_predicted) const {
  const double dt = clock->step;
  const double beta = newmark->beta;
  const double gamma = newmark->gamma;
  *rates = newmark_rates(*clock, *newmark);
  for_each_row(v_i.size(), [&](std::size_t i) {
    v_predicted[i] = -(gamma / beta - 1) * v_i[i] - (dt / 2 * (gamma / beta - 2)) * a_i[i];
    a_predicted[i] = -1 / (beta * dt) * v_i[i] - (1 / (2 * beta) - 1) * a_i[i];
  });
}

template <int Dim>
void CorrectNewmark<Dim>::operator()(Read<Rates> rates, Read<node::Displacement<Dim>> u_i,
                                     Read<node::PredictedVelocity<Dim>> v_predicted,
                                     Read<node::PredictedAcceleration<Dim>> a_predicted,
                                     Write<node::NewVelocity<Dim>> v_new,
                                     Write<node::NewAcceleration<Dim>> a_new) const {
  for_each_row(u_i.size(), [&](std::size_t i) {
    v_new[i] = rates->velocity * u_i[i] + v_predicted[i];
    a_new[i] = rates->acceleration * u_i[i] + a_predicted[i];
  });
}

template <int Dim>
void PredictBackwardEuler<Dim>::operator()(Read<Clock> clock, Read<node::Velocity<Dim>> v_i, Write<Rates> rates,
                                           Write<node::PredictedVelocity<Dim>> v_predicted,
                                           Write<node::PredictedAcceleration<Dim>> a_predicted) const {
  const double dt = clock->step;
  *rates = backward_euler_rates(*clock);
  for_each_row(v_i.size(), [&](std::size_t i) {
    v_predicted[i].setZero();
    a_predicted[i] = -1 / dt * v_i[i];
  });
}

template <int Dim>
void CorrectBackwardEuler<Dim>::operator()(Read<Rates> rates, Read<node::Displacement<Dim>> u_i,
                                           Read<node::PredictedAcceleration<Dim>> a_predicted,
                                           Write<node::NewAcceleration<Dim>> a_new) const {
  for_each_row(u_i.size(), [&](std::size_t i) { a_new[i] = rates->acceleration * u_i[i] + a_predicted[i]; });
}

template <int Dim>
void CorrectBackwardEulerVelocity<Dim>::operator()(Read<Rates> rates, Read<node::Displacement<Dim>> u_i,
                                                   Write<node::NewVelocity<Dim>> v_new) const {
  for_each_row(u_i.size(), [&](std::size_t i) { v_new[i] = rates->velocity * u_i[i]; });
}

template struct PredictNewmark<2>;
template struct PredictNewmark<3>;
template struct CorrectNewmark<2>;
template struct CorrectNewmark<3>;
template struct PredictBackwardEuler<2>;
template struct PredictBackwardEuler<3>;
template struct CorrectBackwardEuler<2>;
template struct CorrectBackwardEuler<3>;
template struct CorrectBackwardEulerVelocity<2>;
template struct CorrectBackwardEulerVelocity<3>;

}  // namespace minamo
