#pragma once
/// \file
/// The time loop: start, steps, frames, checkpoints. What a step does is up to the schedules.

#include "engine/clock.hpp"
#include "engine/schedule.hpp"

#include <atomic>
#include <functional>
#include <optional>
#include <string>

namespace minamo {

/// When to stop, and what to do on the way.
struct TimePlan {
  double end = 0;                             ///< [s]
  std::optional<double> step;                 ///< fixed length [s]
  std::function<double(World&)> choose_step;  ///< length of the next step, where it is not fixed [s]
  double frame_every = 0;                     ///< [s]
  std::optional<double> checkpoint_every;     ///< [s]
  std::optional<std::int64_t> max_steps;
};

/// What the loop calls; each may be empty.
struct Observers {
  std::function<void(const Clock&)> after_step;
  std::function<void()> write_checkpoint;
};

enum class Ending { done, interrupted, failed };

struct Outcome {
  Ending ending = Ending::done;
  std::string message;  ///< of the failure
};

/// Runs `start` and a frame once, then steps up to the end. Frames and checkpoints fall on the first step that reaches
/// their time. A fixed step is shortened only to end on `plan.end`; a chosen one also to meet frames.
/// A step that throws ends the run as `failed`; a set `stop` ends it as `interrupted` after the step. Both leave a
/// checkpoint.
Outcome run_simulation(World& world, Schedule& start, Schedule& step, Schedule& frame, const TimePlan& plan,
                       const Observers& observers, const std::atomic<bool>& stop);

}  // namespace minamo
