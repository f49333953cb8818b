#include "tools/single_run.hpp"

#include "components/particle.hpp"
#include "engine/checkpoint.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/setup/time_plan.hpp"
#include "tools/progress.hpp"
#include "tools/summary.hpp"

#include <spdlog/fmt/fmt.h>

#include <fstream>

namespace minamo {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_output(const fs::path& path, const std::string& what) {
  throw InputError({{path.string(), {}, what, "a folder for the results (--out)", {}, {}}});
}

/// Makes the folder, without what an earlier run left in it.
void open_output(const fs::path& folder, const SceneFile& scene, World& world) {
  make_output_folder(folder);
  for (const char* name : {"history.csv", "fields.h5", "fields.xdmf", "summary.json", "checkpoint.h5", "trace.json"}) {
    std::error_code error;
    fs::remove(folder / name, error);
    if (error) refuse_output(folder, fmt::format("{} cannot be removed: {}", name, error.message()));
  }
  auto& history = world.resource<HistoryFile>().file;
  history.open(folder / "history.csv");
  if (!history) refuse_output(folder, "cannot be written");
  write_text(folder / "scene.json", scene.as_run.dump(2) + "\n");
  world.resource<FieldsFile>().folder = folder.string();
}

}  // namespace

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::exists(folder) && !fs::is_directory(folder)) refuse_output(folder, "is a file");
  if (error) refuse_output(folder, fmt::format("cannot be made: {}", error.message()));
}

RunResult run_into_folder(const SceneFile& file, const RunPlan& plan, const SystemRegistry& registry,
                          Profiler& profiler, const std::atomic<bool>& stop) {
  const Stopwatch stopwatch;
  const Scene& scene = file.scene;
  World world;
  seed(scene, plan.scene, world);
  Pipeline pipeline = make_pipeline(scene, registry);
  Schedule start(std::move(pipeline.start), world);
  Schedule step(std::move(pipeline.step), world, &profiler);
  Schedule frame(std::move(pipeline.output), world, &profiler);
  open_output(plan.folder, file, world);

  TimePlan times = make_time_plan(scene);
  times.max_steps = plan.steps;
  Progress progress(scene.time.end, plan.steps, world.rows<Particles>(), plan.quiet);
  const Observers observers{
      .after_step = [&](const Clock& clock) { progress.show(clock, world.resource<SolveReport>()); },
      .write_checkpoint = [&] { write_checkpoint(plan.folder / "checkpoint.h5", world, file.as_run.dump()); }};
  const double before_loop = stopwatch.wall_seconds();
  RunResult result;
  result.outcome = run_simulation(world, start, step, frame, times, observers, stop);
  result.loop_seconds = stopwatch.wall_seconds() - before_loop;
  progress.end();

  world.resource<HistoryFile>().file.close();
  result.clock = world.resource<Clock>();
  result.summary = make_summary(plan.scene, result.outcome, plan.threads, stopwatch, profiler, world);
  write_text(plan.folder / "summary.json", result.summary.dump(2) + "\n");
  if (plan.at_end && result.outcome.ending == Ending::done) plan.at_end(world);
  return result;
}

}  // namespace minamo
