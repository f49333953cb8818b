#pragma once
/// \file
/// One line on a terminal that tells how far a run is.

#include "engine/clock.hpp"
#include "engine/linear_solver.hpp"
#include "engine/simulation.hpp"
#include "tools/machine.hpp"

namespace minamo {

/// Shows nothing where stderr is not a terminal.
class Progress {
 public:
  /// \param start  where the run begins, or goes on
  Progress(const TimePlan& plan, const Clock& start, std::size_t particles, bool quiet);
  void show(const Clock& clock, const SolveReport& solve);
  void end();

 private:
  /// Share of the run that is behind it.
  double done(const Clock& clock) const;

  double end_;
  std::optional<std::int64_t> max_steps_;
  double done_before_;
  std::size_t particles_;
  bool active_;
  Stopwatch stopwatch_;
  double last_shown_ = -1;
};

}  // namespace minamo
