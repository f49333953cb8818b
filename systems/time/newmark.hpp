#pragma once
/// \file
/// Newmark's method: the balances hold at the end of the step, on the configuration at its start.
///
/// Divergence and pressure gradient are taken on a geometry one step old, so the method is first order in time. In a
/// rotating flow every v^n but the given v^0 therefore has a divergence of dt tr(grad v grad v) on configuration n.
/// The start makes up for that: a^0 comes from a backward Euler step on the configuration one step *before* x^0, where
/// v^0 has the divergence that the method expects. Any other a^0 leaves an oscillation in a and p that beta = 1/4,
/// gamma = 1/2 never damp.

#include "components/node.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E10)  c_v = gamma/(beta dt), c_a = 1/(beta dt^2), at the end of the step.
inline Rates newmark_rates(const Clock& clock, const NewmarkParameters& newmark) {
  const double dt = clock.step;
  return {.velocity = newmark.gamma / (newmark.beta * dt),
          .acceleration = 1 / (newmark.beta * dt * dt),
          .time = clock.time + dt};
}

/// (E13)  c_v = 1/dt, c_a = 1/dt^2, of a standing step.
inline Rates backward_euler_rates(const Clock& clock) {
  const double dt = clock.step;
  return {.velocity = 1 / dt, .acceleration = 1 / (dt * dt), .time = clock.time};
}

/// (E10)  c_v = gamma/(beta dt), v^ = -(gamma/beta - 1) v^n - dt/2 (gamma/beta - 2) a^n;
///        c_a = 1/(beta dt^2),   a^ = -v^n/(beta dt) - (1/(2 beta) - 1) a^n.
template <int Dim>
struct PredictNewmark {
  static constexpr Doc doc = "(E10) rates and known parts, newmark";
  void operator()(Read<Clock> clock, Read<NewmarkParameters> newmark, Read<node::Velocity<Dim>> v_i,
                  Read<node::Acceleration<Dim>> a_i, Write<Rates> rates,
                  Write<node::PredictedVelocity<Dim>> v_predicted,
                  Write<node::PredictedAcceleration<Dim>> a_predicted) const;
};

/// (E10)  v^{n+1} = c_v u + v^, a^{n+1} = c_a u + a^.
template <int Dim>
struct CorrectNewmark {
  static constexpr Doc doc = "(E10) v_I and a_I at the end of the step, newmark";
  void operator()(Read<Rates> rates, Read<node::Displacement<Dim>> u_i, Read<node::PredictedVelocity<Dim>> v_predicted,
                  Read<node::PredictedAcceleration<Dim>> a_predicted, Write<node::NewVelocity<Dim>> v_new,
                  Write<node::NewAcceleration<Dim>> a_new) const;
};

/// (E13)  Backward Euler: c_v = 1/dt, v^ = 0; c_a = 1/dt^2, a^ = -v^n/dt.
template <int Dim>
struct PredictBackwardEuler {
  static constexpr Doc doc = "(E13) rates and known parts, starting step";
  void operator()(Read<Clock> clock, Read<node::Velocity<Dim>> v_i, Write<Rates> rates,
                  Write<node::PredictedVelocity<Dim>> v_predicted,
                  Write<node::PredictedAcceleration<Dim>> a_predicted) const;
};

/// (E13)  a^0 = c_a u + a^.
template <int Dim>
struct CorrectBackwardEuler {
  static constexpr Doc doc = "(E13) a_I of the starting step";
  void operator()(Read<Rates> rates, Read<node::Displacement<Dim>> u_i,
                  Read<node::PredictedAcceleration<Dim>> a_predicted, Write<node::NewAcceleration<Dim>> a_new) const;
};

/// (E13)  v = c_v u.
template <int Dim>
struct CorrectBackwardEulerVelocity {
  static constexpr Doc doc = "(E13) v_I of the starting step";
  void operator()(Read<Rates> rates, Read<node::Displacement<Dim>> u_i, Write<node::NewVelocity<Dim>> v_new) const;
};

}  // namespace minamo
