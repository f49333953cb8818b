#include "engine/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Multiples of an interval, met one after the other.
class Recurrence {
 public:
  explicit Recurrence(std::optional<double> interval) : interval_(interval) {}
  /// Whether the next time is reached; if so it moves on.
  bool due(double time, double step) {
    if (!interval_ || time < next() - tolerance(step)) return false;
    while (next() <= time + tolerance(step)) ++count_;
    return true;
  }
  double next() const { return static_cast<double>(count_) * *interval_; }

 private:
  // Times add up rounding; a thousandth of a step is far above that and far below a step.
  static double tolerance(double step) { return 1e-3 * step; }
  std::optional<double> interval_;
  std::int64_t count_ = 1;
};

/// Sets the length and the end of the next step.
void plan_step(const TimePlan& plan, double next_frame, World& world, Clock& clock) {
  const double wanted = plan.step ? *plan.step : plan.choose_step(world);
  double target = clock.time + wanted;
  // Multiples of the step carry no sum of rounding errors.
  if (plan.step) target = static_cast<double>(clock.index + 1) * *plan.step;
  if (!plan.step) target = std::min(target, std::max(next_frame, clock.time + 1e-3 * wanted));
  if (target > plan.end - 1e-6 * wanted) target = plan.end;
  clock.step = plan.step && target != plan.end ? wanted : target - clock.time;
  clock.end_of_step = target;
}

}  // namespace

Outcome run_simulation(World& world, Schedule& start, Schedule& step, Schedule& frame, const TimePlan& plan,
                       const Observers& observers, const std::atomic<bool>& stop) {
  Clock& clock = world.resource<Clock>();
  Recurrence frames(plan.frame_every);
  Recurrence checkpoints(plan.checkpoint_every);
  const auto checkpoint = [&] {
    if (observers.write_checkpoint) observers.write_checkpoint();
  };
  bool started = false;
  try {
    clock.step = plan.step ? *plan.step : plan.choose_step(world);
    start.run();
    frame.run();
    started = true;
    while (clock.time < plan.end && (!plan.max_steps || clock.index < *plan.max_steps)) {
      plan_step(plan, frames.next(), world, clock);
      step.run();
      clock.time = clock.end_of_step;
      ++clock.index;
      if (observers.after_step) observers.after_step(clock);
      const bool last = clock.time >= plan.end || (plan.max_steps && clock.index >= *plan.max_steps);
      if (frames.due(clock.time, clock.step) || last) frame.run();
      if (checkpoints.due(clock.time, clock.step)) checkpoint();
      if (stop && !last) {
        checkpoint();
        return {Ending::interrupted, {}};
      }
    }
  } catch (const std::exception& failure) {
    if (started) checkpoint();
    return {Ending::failed, failure.what()};
  }
  return {Ending::done, {}};
}

}  // namespace minamo
