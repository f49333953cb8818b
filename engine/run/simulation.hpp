#pragma once
/// \file
/// The time loop: start, steps, frames, checkpoints. What a step does is up to the schedules.

#include "engine/run/clock.hpp"
#include "engine/run/step_control.hpp"
#include "engine/schedule/schedule.hpp"

#include <atomic>
#include <functional>
#include <memory>
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
  std::optional<std::int64_t> max_steps;      ///< of the whole run
  std::int64_t record_every = 1;              ///< steps that run their whole list; the last of a run does, too
  std::size_t unrecorded = 0;                 ///< so many systems, the first of the list, run in all others
};

/// Whether nothing is left to do at that time.
bool is_over(const TimePlan& plan, const Clock& clock);

/// What the loop calls; each may be empty.
struct Observers {
  std::function<void(const Clock&)> after_step;
  /// An attempt was not accepted, and another follows. The clock is that of the attempt.
  std::function<void(const Clock&, const std::string& why)> after_rejection;
  std::function<void()> write_checkpoint;
};

enum class Ending { done, interrupted, failed };

struct Outcome {
  Ending ending = Ending::done;
  std::string message;  ///< of the failure
};

/// How a run begins.
enum class Beginning {
  start,         ///< with the schedule `start` and a frame
  continuation,  ///< with the state that is in the world, which a checkpoint has left
};

/// The loop of run_simulation() for a caller that looks at the world between steps, or changes it.
class TimeLoop {
 public:
  /// \pre The world and its schedules outlive the loop.
  TimeLoop(World& world, Schedule& step, Schedule& frame, const TimePlan& plan, const Observers& observers);
  ~TimeLoop();
  TimeLoop(TimeLoop&&) noexcept;
  TimeLoop& operator=(TimeLoop&&) noexcept;

  /// The first frame. \throws what a system throws
  void begin(Schedule& start);
  bool is_over() const;
  /// One accepted step, after as many attempts as it takes, and the frame that it reaches.
  /// \throws std::runtime_error if the shortest attempt is rejected, or what a system throws; the state is then that
  /// before the step.
  /// \pre begin() was called.
  void take_step();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Runs `start` and a frame once, then steps up to the end. Frames and checkpoints fall on the first step that reaches
/// their time; a checkpoint is written after the start and at the end, too. A frame that shows the end out of turn
/// comes after that checkpoint, so that a longer run does not have it. A fixed step is shortened only to end on
/// `plan.end`, the last two by the same share where one would be a sliver; chosen ones also to meet frames, in the same
/// way. An attempt at a step that throws StepRejected is taken back and made again at half the length (StepControl). If
/// the shortest is rejected, too, or something else is thrown, the run ends as `failed`; a set `stop` ends it as
/// `interrupted` after the step. Both leave a checkpoint of the last accepted state.
Outcome run_simulation(World& world, Schedule& start, Schedule& step, Schedule& frame, const TimePlan& plan,
                       const Observers& observers, const std::atomic<bool>& stop,
                       Beginning beginning = Beginning::start);

}  // namespace minamo
