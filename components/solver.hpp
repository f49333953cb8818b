#pragma once
/// \file
/// What a solver carries from step to step.

#include "engine/component.hpp"

namespace minamo {

/// Steps for which the preconditioner of the pressure is still to be factorized in double precision. [1]
struct DoublePrecision {
  int steps = 0;
  static constexpr ComponentInfo info{"solve.double_precision", "", "1", Lifetime::state};
};

}  // namespace minamo
