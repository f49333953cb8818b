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

Progress::Progress(double end, std::optional<std::int64_t> max_steps, std::size_t particles, bool quiet)
    : end_(end), max_steps_(max_steps), particles_(particles), active_(!quiet && isatty(STDERR_FILENO) == 1) {}

void Progress::show(const Clock& clock, const SolveReport& solve) {
  constexpr double seconds_between = 0.1;
  const double now = stopwatch_.wall_seconds();
  if (!active_ || now < last_shown_ + seconds_between) return;
  last_shown_ = now;
  double done = clock.time / end_;
  if (max_steps_) done = std::max(done, static_cast<double>(clock.index) / static_cast<double>(*max_steps_));
  const double remaining = done > 0 ? now * (1 - done) / done : 0;
  fmt::print(stderr,
             "\r\033[K{:3.0f} %  t = {:.5g} of {:.5g} s  step {}  dt = {:.3g} s  {} particles  {} unknowns  {} left",
             100 * done, clock.time, end_, clock.index, clock.step, particles_, solve.unknowns, duration(remaining));
  std::fflush(stderr);
}

void Progress::end() {
  if (active_ && last_shown_ >= 0) fmt::print(stderr, "\r\033[K");
}

}  // namespace minamo
