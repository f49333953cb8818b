#include "tools/progress.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace minamo {

namespace {

std::string duration(double seconds) {
  const auto s = static_cast<long>(seconds);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

Progress::Progress(const TimePlan& plan, const Clock& start, std::size_t particles, bool quiet)
    : end_(plan.end),
      max_steps_(plan.max_steps),
      done_before_(done(start)),
      particles_(particles),
      active_(!quiet && isatty(STDERR_FILENO) == 1) {}

double Progress::done(const Clock& clock) const {
  const double of_time = clock.time / end_;
  return max_steps_ ? std::max(of_time, static_cast<double>(clock.index) / static_cast<double>(*max_steps_)) : of_time;
}

void Progress::show(const Clock& clock, const SolveReport& solve) {
  constexpr double seconds_between = 0.1;
  if (!active_) return;
  const double now = stopwatch_.wall_seconds();
  if (now < last_shown_ + seconds_between) return;
  last_shown_ = now;
  const double share = done(clock);
  const double remaining = share > done_before_ ? now * (1 - share) / (share - done_before_) : 0;
  fmt::print(stderr,
             "\r\033[K{:3.0f} %  t = {:.5g} of {:.5g} s  step {}  dt = {:.3g} s  {} particles  {} unknowns  {} "
             "iterations  {} left",
             100 * share, clock.time, end_, clock.index, clock.step, particles_, solve.unknowns, solve.iterations,
             duration(remaining));
  std::fflush(stderr);
}

void Progress::end() {
  if (active_ && last_shown_ >= 0) fmt::print(stderr, "\r\033[K");
}

}  // namespace minamo
