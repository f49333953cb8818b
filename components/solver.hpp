#pragma once
/// \file
/// What a solver carries from step to step.

#include "engine/component.hpp"

namespace minamo {

/// Steps for which the preconditioner of the pressure is still to be factorized whole: in double precision, with all
/// that fills in. [1]
struct WholeFactors {
  int steps = 0;
  static constexpr ComponentInfo info{"solve.whole_factors", "", "1", Lifetime::state};
};

}  // namespace minamo
