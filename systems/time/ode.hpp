#pragma once
/// \file
/// The `ode` block of a scene: variables that are integrated along with the flow, for its exact solution or its body
/// force.

#include "components/instant.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E40)  da_k/dt = f_k(t, a), by the classical Runge-Kutta method, in as many equal parts as it takes: 4, 8, 16, ...
/// until twice as many change no variable by more than 1e-13 of itself, or 4096, which a rate that jumps may need.
/// \pre `rate` has as many expressions as `from` has variables.
Instant advance(std::span<const Expression> rate, const Instant& from, double to);

/// (E40)  from the start of the step to the instant of the balances, and on to the end of the step.
/// \throws StepRejected, with its name, if a variable becomes infinite or NaN.
template <int Dim>
struct IntegrateOde {
  static constexpr Doc doc = "(E40) the ode variables of the scene";
  void operator()(Read<Clock> clock, Read<Rates> rates, Read<ode::Equations> equations, Update<ode::Values> values,
                  Write<ode::AtBalances> at_balances) const;
};

/// For the start, whose balances hold before the first step.
template <int Dim>
struct HoldOde {
  static constexpr Doc doc = "the ode variables at the start";
  void operator()(Read<ode::Values> values, Write<ode::AtBalances> at_balances) const;
};

}  // namespace minamo
