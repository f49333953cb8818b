#pragma once
/// \file
/// How far a run is: a line that changes on a terminal, now and then a line of the log elsewhere.

#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/run/simulation.hpp"
#include "tools/program/machine.hpp"

#include <string>

namespace minamo {

/// What a line of progress can tell.
struct ProgressFacts {
  double share = 0;  ///< of the run that is behind it [1]
  Clock clock;
  double end = 0;  ///< [s]
  std::size_t particles = 0;
  SolveReport solve;
  double remaining = 0;  ///< wall time until the end [s]
};

/// As many facts as fit into so many columns, those that matter most.
std::string progress_text(const ProgressFacts& facts, std::size_t columns);

/// When the log gets a line: with every tenth of the run, but no two within a minute.
class LogPace {
 public:
  /// \param share  of the run that is behind it at the start
  explicit LogPace(double share);
  /// \param seconds  of wall time since the start
  bool is_due(double share, double seconds);

 private:
  int tenths_;
  double last_ = 0;
};

class Progress {
 public:
  /// \param start  where the run begins, or goes on
  Progress(const TimePlan& plan, const Clock& start, bool quiet);
  void show(const Clock& clock, std::size_t particles, const SolveReport& solve);
  void end() const;

 private:
  /// Share of the run that is behind it.
  double done(const Clock& clock) const;
  /// Whether now is the time to show something.
  bool is_due(double share, double seconds);

  double end_;
  std::optional<std::int64_t> max_steps_;
  double done_before_;
  bool quiet_;
  bool at_foot_;
  LogPace pace_;
  Stopwatch stopwatch_;
  double last_shown_ = -1;
};

}  // namespace minamo
