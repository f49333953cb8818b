#pragma once
/// \file
/// Where a run stands in time.

#include "engine/storage/component.hpp"

namespace minamo {

/// The time of a step, for systems: `Read<Clock> clock`, then `clock->time`.
struct Clock {
  double time = 0;         ///< at the start of the step [s]
  double step = 0;         ///< length of the step [s]
  double end_of_step = 0;  ///< time + step, without rounding that adds up; 0 before the first step [s]
  std::int64_t index = 0;  ///< steps done
  static constexpr ComponentInfo info{"clock", "t, dt", "s", Lifetime::state};
};

}  // namespace minamo
