#include "engine/run/simulation.hpp"

#include "engine/run/communicator.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <new>
#include <sstream>

namespace minamo {

// Not unnamed: TimeLoop, which others see, holds one.
namespace detail {

/// Multiples of an interval, met one after the other.
class Recurrence {
 public:
  /// The first is the one after `time`, where a step of that length ended.
  Recurrence(std::optional<double> interval, double time, double step) : interval_(interval) { due(time, step); }
  /// Whether the next time is reached; if so it moves on.
  bool due(double time, double step) {
    // Times add up rounding; a thousandth of a step is far above that and far below a step.
    const double reached = time + 1e-3 * step;
    if (!interval_ || reached < next()) return false;
    multiple_ = std::floor(reached / *interval_) + 1;
    return true;
  }
  double next() const { return multiple_ * *interval_; }

 private:
  std::optional<double> interval_;
  double multiple_ = 1;
};

/// Lengths of steps, and where they end.
class Stepper {
 public:
  Stepper(const TimePlan& plan, World& world)
      : plan_(plan), world_(world), clock_(world.resource<Clock>()), control_(world.resource<StepControl>()) {}

  double wanted() const { return plan_.step ? *plan_.step : plan_.choose_step(world_); }

  /// Sets the length and the end of the next attempt.
  void plan(double next_frame) {
    const double uncut = wanted();
    const double step = uncut * control_.share();
    ticks_ = control_.ticks;
    double target = plan_.step ? along_ticks(uncut, step) : towards(std::min(next_frame, plan_.end), step);
    if (target > plan_.end - 1e-6 * step) target = plan_.end;
    const bool is_whole = plan_.step && std::abs(target - clock_.time - step) < 1e-6 * step;
    clock_.step = is_whole ? step : target - clock_.time;
    clock_.end_of_step = target;
  }
  void accept() {
    clock_.time = clock_.end_of_step;
    ++clock_.index;
    control_.accept(ticks_ - control_.ticks);
  }

 private:
  /// Where a step of at most that length ends on the way to a time that is to be met. A rest of less than two steps is
  /// taken in halves: a sliver after a long step is hard on integrators that carry accelerations from one to the next.
  double towards(double goal, double step) const {
    const double rest = goal - clock_.time;
    if (rest >= 2 * step) return clock_.time + step;
    if (rest > (1 + 1e-3) * step) return clock_.time + rest / 2;
    return std::max(goal, clock_.time + 1e-3 * step);
  }
  /// Where a fixed step ends: on its next tick. The end need not be one, nor need the place where an earlier run ended;
  /// what would leave a sliver is shared by two steps.
  double along_ticks(double uncut, double step) {
    const double tick = uncut / static_cast<double>(StepControl::ticks_per_step);
    std::int64_t next = control_.ticks + control_.ticks_ahead();
    while (static_cast<double>(next) * tick < clock_.time + 1e-6 * step) next += control_.ticks_ahead();
    const double target = static_cast<double>(next) * tick;
    const double rest = plan_.end - clock_.time;
    if (std::abs(target - plan_.end) > 1e-6 * step) {
      if (rest <= step) return plan_.end;
      if (rest < 1.5 * step) return clock_.time + rest / 2;
      if (target < clock_.time + step / 2) return (clock_.time + target + step) / 2;
    }
    ticks_ = next;
    return target;
  }

  const TimePlan& plan_;
  World& world_;
  Clock& clock_;
  StepControl& control_;
  std::int64_t ticks_ = 0;  ///< where the attempt ends, or those before it
};

static std::string shown(double seconds) {
  std::ostringstream text;
  text << std::setprecision(6) << seconds;
  return text.str();
}

/// The loop of run_simulation().
class Loop {
 public:
  Loop(World& world, Schedule& step, Schedule& frame, const TimePlan& plan, const Observers& observers)
      : world_(world),
        step_(step),
        frame_(frame),
        plan_(plan),
        observers_(observers),
        clock_(world.resource<Clock>()),
        stepper_(plan_, world) {}

  void start(Schedule& start) {
    clock_.step = stepper_.wanted();
    start.run();
    frame_.run();
  }

  /// One accepted step. \return whether it had a frame
  bool take_step(Recurrence& frames) {
    attempt_until_accepted(frames.next());
    if (observers_.after_step) observers_.after_step(clock_);
    const bool has_frame = frames.due(clock_.time, clock_.step);
    if (has_frame) take_frame();
    return has_frame;
  }

  Recurrence frames_ahead() const { return {plan_.frame_every, clock_.time, clock_.step}; }

  /// \return how the run ended
  Ending run(const std::atomic<bool>& stop) {
    Recurrence frames = frames_ahead();
    Recurrence checkpoints(plan_.checkpoint_every, clock_.time, clock_.step);
    while (!is_over()) {
      const bool has_frame = take_step(frames);
      const bool is_stopped = largest_over_ranks(stop ? 1 : 0) > 0;
      if (checkpoints.due(clock_.time, clock_.step) || is_over() || is_stopped) checkpoint();
      if (is_over() && !has_frame) frame_.run();
      if (is_stopped && !is_over()) return Ending::interrupted;
    }
    return Ending::done;
  }

  void checkpoint() const {
    if (observers_.write_checkpoint) observers_.write_checkpoint();
  }

  bool is_over() const { return minamo::is_over(plan_, clock_); }

 private:
  /// As many attempts at a step as it takes.
  void attempt_until_accepted(double next_frame) {
    for (;;) {
      stepper_.plan(next_frame);
      world_.mark();
      try {
        run_step();
        stepper_.accept();
        return;
      } catch (const StepRejected& rejected) {
        world_.roll_back();
        retry(rejected);
      } catch (...) {
        world_.roll_back();
        throw;
      }
    }
  }

  void run_step() {
    if (is_recorded()) {
      step_.run();
    } else {
      step_.run_first(plan_.unrecorded);
    }
  }

  /// Of the attempt that the clock is at.
  bool is_recorded() const {
    const Clock after{.time = clock_.end_of_step, .step = clock_.step, .end_of_step = 0, .index = clock_.index + 1};
    return after.index % plan_.record_every == 0 || minamo::is_over(plan_, after);
  }

  void retry(const StepRejected& rejected) {
    if (!world_.resource<StepControl>().reject()) {
      throw std::runtime_error(std::string(rejected.what()) + " (step " + std::to_string(clock_.index + 1) +
                               ", t = " + shown(clock_.time) +
                               " s, not even with the shortest dt = " + shown(clock_.step) + " s)");
    }
    if (observers_.after_rejection) observers_.after_rejection(clock_, rejected.what());
  }

  /// A step whose frame cannot be written has not been taken: a continuation makes both again.
  void take_frame() {
    try {
      frame_.run();
    } catch (...) {
      world_.roll_back();
      throw;
    }
  }

  World& world_;
  Schedule& step_;
  Schedule& frame_;
  const TimePlan plan_;
  const Observers observers_;
  Clock& clock_;
  Stepper stepper_;
};

}  // namespace detail

namespace {

using detail::Loop;

/// What went wrong, also where there is no memory left to say much.
std::string message_of(const std::exception& failure) {
  if (dynamic_cast<const std::bad_alloc*>(&failure)) return "out of memory";
  return failure.what();
}

/// Leaves a checkpoint of a run that has failed. \return the message, with what goes wrong now
std::string last_words(const Loop& loop, std::string message) {
  try {
    loop.checkpoint();
  } catch (const std::exception& failure) {
    // The same disk may be full again.
    if (message != message_of(failure)) message.append("\n").append(message_of(failure));
  }
  return message;
}

}  // namespace

bool is_over(const TimePlan& plan, const Clock& clock) {
  return clock.time >= plan.end || (plan.max_steps && clock.index >= *plan.max_steps);
}

struct TimeLoop::Impl {
  Loop loop;
  std::optional<detail::Recurrence> frames = {};  // known when the first step's length is
};

TimeLoop::TimeLoop(World& world, Schedule& step, Schedule& frame, const TimePlan& plan, const Observers& observers)
    : impl_(new Impl{.loop = {world, step, frame, plan, observers}}) {}
TimeLoop::~TimeLoop() = default;
TimeLoop::TimeLoop(TimeLoop&&) noexcept = default;
TimeLoop& TimeLoop::operator=(TimeLoop&&) noexcept = default;

void TimeLoop::begin(Schedule& start) {
  impl_->loop.start(start);
  impl_->frames = impl_->loop.frames_ahead();
}

bool TimeLoop::is_over() const { return impl_->loop.is_over(); }

void TimeLoop::take_step() { impl_->loop.take_step(*impl_->frames); }

Outcome run_simulation(World& world, Schedule& start, Schedule& step, Schedule& frame, const TimePlan& plan,
                       const Observers& observers, const std::atomic<bool>& stop, Beginning beginning) {
  Loop loop(world, step, frame, plan, observers);
  try {
    if (beginning == Beginning::start) loop.start(start);
  } catch (const std::exception& failure) {
    return {Ending::failed, message_of(failure) + " (before the first step)"};
  }
  try {
    if (beginning == Beginning::start) loop.checkpoint();
    return {loop.run(stop), {}};
  } catch (const std::exception& failure) {
    return {Ending::failed, last_words(loop, message_of(failure))};
  }
}

}  // namespace minamo
