#pragma once
/// \file
/// How far the particles are from the exact solution of the scene, as columns of the history.
///
/// Both norms are relative. Where the exact field is zero at all particles (liquid at rest, the pressure of a free
/// flight) there is nothing to relate to, and the column has the root mean square of the difference itself, in m/s or
/// Pa. After the time up to which the solution is known it is NaN.

#include "components/exact.hpp"
#include "components/instant.hpp"
#include "components/measure.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E41)  error_velocity = sqrt(sum V_p |v_p - v_e(x_p)|^2 / sum V_p |v_e(x_p)|^2), at the end of the step.
template <int Dim>
struct MeasureErrorVelocity {
  static constexpr Doc doc = "(E41) error of the velocity";
  void operator()(Read<exact::Velocity> exact, Read<Clock> clock, Optional<Read<ode::Values>> ode,
                  Read<particle::Volume> V_p, Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                  Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const;
};

/// (E42)  error_pressure = sqrt(sum V_p (p_p - p_e(y_p))^2 / sum V_p p_e(y_p)^2), p_p of (E33): where and when the
/// balances hold, which with newmark is the end of the step on the configuration at its start, with midpoint the middle
/// of the step. If the exact pressure is free, both p lose their mean sum V_p p / sum V_p first. At the start p_p is
/// that of (E13), one step ahead of x^0, against p_e at t = 0: an error of order dt that no step has.
template <int Dim>
struct MeasureErrorPressure {
  static constexpr Doc doc = "(E42) error of the pressure";
  void operator()(Read<exact::Pressure> exact, Read<Rates> rates, Optional<Read<ode::AtBalances>> ode,
                  Read<particle::Volume> V_p, Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Pressure> p_p,
                  Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const;
};

}  // namespace minamo
