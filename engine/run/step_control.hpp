#pragma once
/// \file
/// Steps that are not accepted: who says so, and how much shorter the next attempt is.

#include "engine/storage/component.hpp"

#include <cstdint>
#include <stdexcept>

namespace minamo {

/// Thrown by a system that finds a step unacceptable in a way that a shorter one may mend. The state goes back to what
/// it was before the step. Whatever else a system throws ends the run.
class StepRejected : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How much shorter than wanted steps are. A rejected step is tried again at half its length; after some accepted ones
/// the length doubles again.
struct StepControl {
  static constexpr int most_halvings = 10;  ///< a step is never shorter than 2^-10 of what is wanted
  /// Parts of a fixed step. Times are whole numbers of them, so that they carry no sum of rounding errors, and those of
  /// uncut steps are met again after cut ones.
  static constexpr std::int64_t ticks_per_step = std::int64_t{1} << most_halvings;
  /// So that what was rejected is not tried again at once.
  static constexpr int accepted_before_doubling = 4;

  int halvings = 0;           ///< the step is 2^-halvings of what is wanted
  int accepted = 0;           ///< steps since the length last changed
  std::int64_t ticks = 0;     ///< time, where the step is fixed
  std::int64_t rejected = 0;  ///< attempts, in the whole run
  static constexpr ComponentInfo info{"step_control", "", "1", Lifetime::state};

  /// Length of the step over the wanted one.
  double share() const { return 1.0 / static_cast<double>(std::int64_t{1} << halvings); }
  /// Length of the step in ticks.
  std::int64_t ticks_ahead() const { return ticks_per_step >> halvings; }

  /// Counts an accepted step, that many ticks long; 0 where the step is not fixed.
  void accept(std::int64_t ticks_passed) {
    ticks += ticks_passed;
    ++accepted;
    // A doubled step begins on a multiple of itself.
    if (halvings == 0 || accepted < accepted_before_doubling || ticks % (2 * ticks_ahead()) != 0) return;
    --halvings;
    accepted = 0;
  }
  /// Counts a rejected attempt. \return whether there is a shorter step to try
  bool reject() {
    ++rejected;
    accepted = 0;
    if (halvings == most_halvings) return false;
    ++halvings;
    return true;
  }
};

}  // namespace minamo
