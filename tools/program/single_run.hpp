#pragma once
/// \file
/// One run of a scene into a folder, as `minamo run` and every variant of a study do it.

#include "engine/run/profiler.hpp"
#include "engine/run/simulation.hpp"
#include "tools/program/scene_file.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace minamo {

/// Which results of earlier runs may go.
enum class Replaced {
  finished_runs,
  all_runs,
  own_runs,  ///< all, and of those of the same scene nothing is said: they are the caller's
};

struct RunPlan {
  std::string scene;                               ///< the scene file, as the messages and summary.json call it
  std::filesystem::path folder;                    ///< for the results
  std::vector<std::filesystem::path> inputs = {};  ///< files apart from the scene and those that it refers to
  int threads = 1;                                 ///< that the caller has set, for summary.json
  std::optional<std::int64_t> steps;               ///< of the whole run
  Beginning beginning = Beginning::start;
  Replaced replaced = Replaced::finished_runs;
  bool quiet = false;
  std::function<void(World&)> at_end;  ///< called where the run is done; may be empty
};

struct RunResult {
  Outcome outcome;
  Clock clock;
  std::optional<Clock> checkpoint;  ///< that of the last good one in the folder
  Json summary;                     ///< as in summary.json
  double loop_seconds = 0;          ///< wall time of the time loop [s]
  double loop_cpu_seconds = 0;      ///< processor time of the time loop, all threads [s]
  bool was_over = false;            ///< the checkpoint is that of the end; nothing was run or written
};

/// Runs the scene and writes all that a run leaves but the trace.
/// \throws InputError if the scene cannot be seeded, the folder cannot be used, another run writes into it, an input
/// lies where a result would, an unfinished run is there and may not be replaced, or its checkpoint does not fit;
/// nothing is run then.
RunResult run_into_folder(const SceneFile& file, const RunPlan& plan, Profiler& profiler,
                          const std::atomic<bool>& stop);

}  // namespace minamo
