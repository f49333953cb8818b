#include "tools/program/commands.hpp"

#include "engine/run/communicator.hpp"
#include "tools/program/interrupt.hpp"
#include "tools/program/machine.hpp"
#include "tools/program/single_run.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <iostream>

namespace minamo {

namespace {

namespace fs = std::filesystem;

fs::path output_folder(const RunOptions& options) {
  return options.out.empty() ? fs::path("out") / fs::path(options.scene).stem() : fs::path(options.out);
}

std::string rows_text(std::int64_t every) {
  return every == 1 ? "a row per step" : fmt::format("a row per {} steps", every);
}

/// What a run that has failed can go on from.
std::string what_is_kept(const RunResult& result, const fs::path& path) {
  if (!result.checkpoint) return {};
  const Clock& kept = *result.checkpoint;
  if (kept.index == 0) return "there is no checkpoint after t = 0 s: the run starts anew\n";
  const std::string came_to =
      kept.index == result.clock.index ? "" : fmt::format(" (the run came to t = {:.6g} s)", result.clock.time);
  return fmt::format("the last good checkpoint is {}, of t = {:.6g} s after {} steps{}; --resume goes on from there\n",
                     path.string(), kept.time, kept.index, came_to);
}

int report(const RunResult& result, const Scene& scene, const fs::path& folder, bool quiet) {
  if (!writes_for_all()) return exit_done;
  const fs::path checkpoint = folder / "checkpoint.h5";
  if (result.outcome.ending == Ending::failed) {
    std::cerr << result.outcome.message << '\n' << what_is_kept(result, checkpoint);
    return exit_failed;
  }
  if (result.was_over) {
    if (quiet) return exit_done;
    spdlog::info("{} is complete: t = {:.6g} s after {} steps; nothing to do", folder.string(), result.clock.time,
                 result.clock.index);
    return exit_done;
  }
  const bool interrupted = result.outcome.ending == Ending::interrupted;
  if (interrupted) {
    spdlog::warn("interrupted at t = {:.6g} s after {} steps; --resume goes on from {}", result.clock.time,
                 result.clock.index, checkpoint.string());
  }
  if (!quiet) {
    spdlog::info("results in {}: open fields.xdmf in ParaView, history.csv has {}", folder.string(),
                 rows_text(scene.output.history));
  }
  return interrupted ? exit_interrupted : exit_done;
}

}  // namespace

int run_scene(const RunOptions& options, const SystemRegistry& registry) {
  const SceneFile file = load_scene(options.scene, options.overrides, registry);
  // Ranks share the processors of a machine; how many threads each may have they cannot know.
  const int threads = prepare_threads(options.threads == 0 && all_ranks() != nullptr ? 1 : options.threads);
  const fs::path folder = output_folder(options);
  Profiler profiler(options.profile);
  const RunPlan plan{.scene = options.scene,
                     .folder = folder,
                     .threads = threads,
                     .steps = options.steps,
                     .beginning = options.resume ? Beginning::continuation : Beginning::start,
                     .replaced = options.overwrite ? Replaced::all_runs : Replaced::finished_runs,
                     .quiet = options.quiet,
                     .at_end = {}};
  const RunResult result = run_into_folder(file, plan, profiler, stop_on_signal());
  if (options.profile && writes_for_all()) {
    if (!options.quiet) std::cout << profiler.table(result.loop_seconds);
    profiler.write_trace(options.trace.empty() ? (folder / "trace.json").string() : options.trace);
  }
  return report(result, file.scene, folder, options.quiet);
}

}  // namespace minamo
