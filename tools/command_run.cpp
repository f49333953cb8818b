#include "tools/commands.hpp"

#include "engine/checkpoint.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/setup/time_plan.hpp"
#include "tools/machine.hpp"
#include "tools/progress.hpp"
#include "tools/scene_file.hpp"
#include "tools/summary.hpp"

#include <oneapi/tbb/global_control.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <filesystem>
#include <iostream>

namespace minamo {

namespace {

std::atomic<bool> stop_requested{false};

extern "C" void request_stop(int signal) {
  stop_requested = true;
  std::signal(signal, SIG_DFL);  // a second one ends the program at once
}

namespace fs = std::filesystem;

fs::path output_folder(const RunOptions& options) {
  return options.out.empty() ? fs::path("out") / fs::path(options.scene).stem() : fs::path(options.out);
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

[[noreturn]] void refuse_output(const fs::path& path, const std::string& what) {
  throw InputError({{path.string(), {}, what, "a folder for the results (--out)", {}, {}}});
}

/// Makes the folder, without what an earlier run left in it.
void open_output(const fs::path& folder, const SceneFile& scene, World& world) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::exists(folder) && !fs::is_directory(folder)) refuse_output(folder, "is a file");
  if (error) refuse_output(folder, fmt::format("cannot be made: {}", error.message()));
  for (const char* name : {"history.csv", "fields.h5", "fields.xdmf", "summary.json", "checkpoint.h5", "trace.json"}) {
    fs::remove(folder / name, error);
    if (error) refuse_output(folder, fmt::format("{} cannot be removed: {}", name, error.message()));
  }
  auto& history = world.resource<HistoryFile>().file;
  history.open(folder / "history.csv");
  if (!history) refuse_output(folder, "cannot be written");
  write_text(folder / "scene.json", scene.as_run.dump(2) + "\n");
  world.resource<FieldsFile>().folder = folder.string();
}

int report(const Outcome& outcome, const fs::path& folder, const Clock& clock, bool quiet) {
  if (outcome.ending == Ending::failed) {
    std::cerr << outcome.message << "\nthe state before this step is in " << (folder / "checkpoint.h5").string()
              << '\n';
    return exit_failed;
  }
  const bool interrupted = outcome.ending == Ending::interrupted;
  if (interrupted) {
    spdlog::warn("interrupted at t = {:.6g} s after {} steps; checkpoint in {}", clock.time, clock.index,
                 (folder / "checkpoint.h5").string());
  }
  if (!quiet) {
    spdlog::info("results in {}: open fields.xdmf in ParaView, history.csv has a row per step", folder.string());
  }
  return interrupted ? exit_interrupted : exit_done;
}

}  // namespace

int run_scene(const RunOptions& options, const SystemRegistry& registry) {
  const Stopwatch stopwatch;
  const SceneFile file = load_scene(options.scene, options.overrides, registry);
  const Scene& scene = file.scene;
  const int threads = prepare_threads(options.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  World world;
  seed(scene, options.scene, world);

  Profiler profiler(options.profile);
  Pipeline pipeline = make_pipeline(scene, registry);
  Schedule start(std::move(pipeline.start), world);
  Schedule step(std::move(pipeline.step), world, &profiler);
  Schedule frame(std::move(pipeline.output), world, &profiler);
  const fs::path folder = output_folder(options);
  open_output(folder, file, world);

  TimePlan plan = make_time_plan(scene);
  plan.max_steps = options.steps;
  Progress progress(scene.time.end, options.steps, world.rows<Particles>(), options.quiet);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  const Observers observers{
      .after_step = [&](const Clock& clock) { progress.show(clock, world.resource<SolveReport>()); },
      .write_checkpoint = [&] { write_checkpoint(folder / "checkpoint.h5", world, file.as_run.dump()); }};
  const double before_loop = stopwatch.wall_seconds();
  const Outcome outcome = run_simulation(world, start, step, frame, plan, observers, stop_requested);
  const double loop_seconds = stopwatch.wall_seconds() - before_loop;
  progress.end();

  world.resource<HistoryFile>().file.close();
  write_text(folder / "summary.json",
             make_summary(options.scene, outcome, threads, stopwatch, profiler, world).dump(2) + "\n");
  if (options.profile) {
    std::cout << profiler.table(loop_seconds);
    profiler.write_trace(options.trace.empty() ? (folder / "trace.json").string() : options.trace);
  }
  return report(outcome, folder, world.resource<Clock>(), options.quiet);
}

}  // namespace minamo
