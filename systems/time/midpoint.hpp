#pragma once
/// \file
/// The midpoint rule: all weights and balances are taken at the middle of the step, y_p = x_p + dt/2 v_p. Second order
/// in time at the cost of newmark, and nothing but position and velocity is carried from step to step.

#include "components/node.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E12)  c_v = 1/dt, c_a = 2/dt^2, in the middle of the step.
inline Rates midpoint_rates(const Clock& clock) {
  const double dt = clock.step;
  return {.velocity = 1 / dt, .acceleration = 2 / (dt * dt), .time = clock.time + dt / 2};
}

/// (E12)  v_mid = u/dt, a_mid = 2 (u/dt - v^n)/dt:  c_v = 1/dt, v^ = 0; c_a = 2/dt^2, a^ = -2 v^n/dt.
template <int Dim>
struct PredictMidpoint {
  static constexpr Doc doc = "(E12) rates and known parts, midpoint";
  void operator()(Read<Clock> clock, Read<node::Velocity<Dim>> v_i, Write<Rates> rates,
                  Write<node::PredictedVelocity<Dim>> v_predicted,
                  Write<node::PredictedAcceleration<Dim>> a_predicted) const;
};

/// (E12)  v^{n+1} = 2 u/dt - v^n.
template <int Dim>
struct CorrectMidpoint {
  static constexpr Doc doc = "(E12) v_I at the end of the step, midpoint";
  void operator()(Read<Clock> clock, Read<node::Displacement<Dim>> u_i, Read<node::Velocity<Dim>> v_i,
                  Write<node::NewVelocity<Dim>> v_new) const;
};

}  // namespace minamo
