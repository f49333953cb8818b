#include "tools/program/progress.hpp"

#include "tools/program/terminal.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace minamo {

namespace {

std::string duration(double seconds) {
  constexpr double longest = 1e9;  // 30 years
  const auto s = static_cast<long>(std::min(seconds, longest));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

/// A fact in words, and how much it matters: 0 most.
struct WordsOfProgress {
  std::string text;
  std::size_t rank;
};

std::array<WordsOfProgress, 8> words_of(const ProgressFacts& facts) {
  return {{{fmt::format("{:3.0f} %", 100 * facts.share), 0},
           {fmt::format("t = {:.5g} of {:.5g} s", facts.clock.time, facts.end), 2},
           {fmt::format("step {}", facts.clock.index), 3},
           {fmt::format("dt = {:.3g} s", facts.clock.step), 4},
           {fmt::format("{} particles", facts.particles), 5},
           {fmt::format("{} unknowns", facts.solve.unknowns), 7},
           {fmt::format("{} iterations", facts.solve.iterations), 6},
           {fmt::format("{} left", duration(facts.remaining)), 1}}};
}

/// The parts that matter more than others, in their order.
template <class Parts>
std::string line_of(const Parts& parts, std::size_t count) {
  std::string line;
  for (const WordsOfProgress& part : parts) {
    if (part.rank < count) line += (line.empty() ? "" : "  ") + part.text;
  }
  return line;
}

}  // namespace

std::string progress_text(const ProgressFacts& facts, std::size_t columns) {
  const auto parts = words_of(facts);
  std::size_t count = parts.size();
  while (count > 1 && line_of(parts, count).size() > columns) --count;
  return line_of(parts, count).substr(0, columns);
}

LogPace::LogPace(double share) : tenths_(static_cast<int>(10 * share)) {}

bool LogPace::is_due(double share, double seconds) {
  constexpr double between = 60;  // [s]
  // A share of 7 steps of 10 is a rounding below 0.7.
  const int tenths = static_cast<int>(10 * share + 1e-9);
  if (tenths <= tenths_ || seconds < last_ + between) return false;
  tenths_ = tenths;
  last_ = seconds;
  return true;
}

Progress::Progress(const TimePlan& plan, const Clock& start, bool quiet)
    : end_(plan.end),
      max_steps_(plan.max_steps),
      done_before_(done(start)),
      quiet_(quiet),
      at_foot_(has_foot()),
      pace_(done_before_) {}

double Progress::done(const Clock& clock) const {
  const double of_time = clock.time / end_;
  return max_steps_ ? std::max(of_time, static_cast<double>(clock.index) / static_cast<double>(*max_steps_)) : of_time;
}

bool Progress::is_due(double share, double seconds) {
  constexpr double between = 0.1;  // [s]
  if (quiet_) return false;
  if (!at_foot_) return pace_.is_due(share, seconds);
  if (seconds < last_shown_ + between) return false;
  last_shown_ = seconds;
  return true;
}

void Progress::show(const Clock& clock, std::size_t particles, const SolveReport& solve) {
  const double now = stopwatch_.wall_seconds();
  const double share = done(clock);
  if (!is_due(share, now)) return;
  const double remaining = share > done_before_ ? now * (1 - share) / (share - done_before_) : 0;
  const ProgressFacts facts{share, clock, end_, particles, solve, remaining};
  if (at_foot_) {
    show_at_foot(progress_text(facts, columns_of_terminal() - 1));  // a full line would end in the next
  } else {
    spdlog::info(progress_text(facts, std::numeric_limits<std::size_t>::max()));
  }
}

void Progress::end() const { clear_foot(); }

}  // namespace minamo
