#pragma once
/// \file
/// One line on a terminal that tells how far a run is.

#include "engine/clock.hpp"
#include "engine/linear_solver.hpp"
#include "tools/machine.hpp"

#include <optional>

namespace minamo {

/// Shows nothing where stderr is not a terminal.
class Progress {
 public:
  Progress(double end, std::optional<std::int64_t> max_steps, std::size_t particles, bool quiet);
  void show(const Clock& clock, const SolveReport& solve);
  void end();

 private:
  double end_;
  std::optional<std::int64_t> max_steps_;
  std::size_t particles_;
  bool active_;
  Stopwatch stopwatch_;
  double last_shown_ = -1;
};

}  // namespace minamo
