#include "systems/scene/time_counts.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

constexpr double most_steps = 1e9;           // at a millisecond each eleven days
constexpr double many_steps = 1e7;           // some hours at least
constexpr double most_frames = 1e6;          // each has its place in fields.xdmf
constexpr double rounding_of_counts = 1e-6;  // of a number of intervals: 0.3/0.1 are three

/// Intervals that begin before the end.
double intervals(double end, double interval) { return std::ceil(end / interval - rounding_of_counts); }

/// Notes a problem if an interval is so short that there are too many of it.
void require_fewer(Input& input, const std::string& key, double interval, double count, double end, double most,
                   const std::string& what) {
  if (count <= most) return;
  input.problem(key, "too short", fmt::format("at most {:.0e} {}", most, what),
                fmt::format("{} s, {:.3g} {} up to the end at {} s", interval, count, what, end));
}

}  // namespace

std::optional<double> steps_of(const TimeScene& time) {
  if (!time.step) return {};
  return std::max(1.0, intervals(time.end, *time.step));
}

double frames_of(const TimeScene& time, const OutputScene& output) {
  const double wanted = 1 + intervals(time.end, output.every);
  return std::min(wanted, 1 + steps_of(time).value_or(wanted));
}

void check_steps(Input& input, const TimeScene& time) {
  if (input.describing() || !input.sound("end")) return;
  const std::optional<double> longest = time.step ? time.step : time.max_step;
  const std::string key = time.step ? "step" : "max_step";
  if (!longest || !input.sound(key)) return;
  const double steps = intervals(time.end, *longest);
  require_fewer(input, key, *longest, steps, time.end, most_steps, "steps");
  if (steps > many_steps && steps <= most_steps)
    input.remark(key, fmt::format("{:.3g} steps up to the end at {} s", steps, time.end));
  if (time.step && *time.step > time.end)
    input.remark(key, fmt::format("{} s is longer than the run, which is one step of {} s", *time.step, time.end));
}

void check_output_times(Input& input, const OutputScene& output, const TimeScene& time) {
  if (input.describing()) return;
  const double most_of_steps = steps_of(time).value_or(most_steps * most_frames);
  if (input.sound("every"))
    require_fewer(input, "every", output.every, frames_of(time, output), time.end, most_frames, "frames");
  if (output.checkpoint && input.sound("checkpoint")) {
    const double checkpoints = std::min(intervals(time.end, *output.checkpoint), most_of_steps);
    require_fewer(input, "checkpoint", *output.checkpoint, checkpoints, time.end, most_frames, "checkpoints");
  }
  const bool is_given = input.has("every");  // the default may well be shorter
  const bool outruns_steps =
      is_given && time.step && output.every < *time.step * (1 - rounding_of_counts) && *time.step <= time.end;
  if (outruns_steps && input.sound("every") && time.end / *time.step <= most_frames)
    input.remark("every", fmt::format("{} s is shorter than a step, {} s: every step has a frame, {:.6g} in all",
                                      output.every, *time.step, frames_of(time, output)));
}

}  // namespace minamo
