#include "tools/program/single_run.hpp"

#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/run/warnings.hpp"
#include "engine/storage/memory_reserve.hpp"
#include "engine/storage/text_file.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/ranks/migrate.hpp"
#include "systems/step/fit_for_ranks.hpp"
#include "systems/step/time_plan.hpp"
#include "systems/time/turns.hpp"
#include "systems/viscosity/creep.hpp"
#include "tools/program/continuation.hpp"
#include "tools/program/earlier_run.hpp"
#include "tools/program/progress.hpp"
#include "tools/program/results_folder.hpp"
#include "tools/program/summary.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <optional>

namespace minamo {

namespace {

namespace fs = std::filesystem;

/// Begins the output of a new run.
void open_output(const fs::path& folder, World& world) {
  remove_results(folder);
  auto& history = world.resource<HistoryFile>();
  history.path = (folder / "history.csv").string();
  history.file.open(history.path);
  if (!history.file) refuse_folder(folder, "cannot be written");
  start_fields(world.resource<FieldsFile>(), folder.string());
}

/// Finds out whether what an earlier run has left may go, and says that it goes.
void make_way(const RunPlan& plan) {
  const auto earlier = earlier_run(plan.folder);
  if (!earlier) return;
  if (earlier->is_worth_keeping() && plan.replaced == Replaced::finished_runs) refuse_to_replace(*earlier, plan.folder);
  tell_of_replaced(*earlier, plan.folder, plan.scene, plan.quiet || plan.replaced == Replaced::own_runs);
}

/// Makes the folder this run's own, and finds out whether its files may be written there.
FolderClaim claim_folder(const RunPlan& plan, const std::string& scene_text, const SceneFile& file) {
  const bool is_start = plan.beginning == Beginning::start;
  if (is_start) make_output_folder(plan.folder);
  FolderClaim claim(plan.folder);
  std::vector<fs::path> inputs = files_named_in(file.as_run);
  inputs.insert(inputs.end(), plan.inputs.begin(), plan.inputs.end());
  // The scene as run may be run again where it is: what is written is what was read, or goes on from it.
  if (is_start && !holds(plan.folder / scene_as_run, scene_text)) inputs.emplace_back(plan.scene);
  require_kept(inputs, plan.folder);
  if (is_start) make_way(plan);
  return claim;
}

/// Makes the output, or takes it up where the checkpoint was written.
/// \param claim  to the folder, for as long as the run lasts
/// \return whether there is anything left to run
bool begin_output(const RunPlan& plan, const SceneFile& file, const TimePlan& times, World& world, FolderClaim& claim) {
  const std::string scene_text = file.as_run.dump(2) + "\n";
  do_on_all(all_ranks(), [&] {
    if (writes_for_all()) claim = claim_folder(plan, scene_text, file);
  });
  std::optional<FieldsPosition> fields;
  if (plan.beginning == Beginning::continuation) {
    fields = load_checkpoint(plan.folder, plan.scene, file, world);
    if (all_ranks() != nullptr) send_particles_home(file.scene.dimension, world);
    if (is_over(times, world.resource<Clock>())) return false;
  }
  do_on_all(all_ranks(), [&] {
    if (!writes_for_all()) return;
    if (fields) {
      continue_output(plan.folder, *fields, world);
      fs::remove(plan.folder / "summary.json");  // of the part before, which a kill from now on would leave to stand
    } else {
      open_output(plan.folder, world);
    }
    write_text(plan.folder / scene_as_run, scene_text);
  });
  return true;
}

/// A summary that cannot be written fails the run, but not its message.
void write_summary(const fs::path& folder, RunResult& result) {
  try {
    write_text(folder / "summary.json", result.summary.dump(2) + "\n");
  } catch (const std::exception& failure) {
    std::string& message = result.outcome.message;
    message += (message.empty() ? "" : "\n") + std::string(failure.what());
    result.outcome.ending = Ending::failed;
  }
}

void warn_of_scene(const Scene& scene, const std::string& path, World& world) {
  for (const std::string& warning : warnings_of(scene, world)) spdlog::warn("{}: {}", path, warning);
}

void tell_of_creep(const Scene& scene, const std::string& path, World& world) {
  for (const std::string& remark : remarks_on_creep(scene, world)) spdlog::info("{}: {}", path, remark);
}

/// Blocks of cells are not shared.
void warn_of_idle_ranks(World& world) {
  if (all_ranks() == nullptr) return;
  const std::int64_t idle = sum_over_ranks(std::int64_t{world.rows<Particles>() == 0});
  if (idle == 0) return;
  spdlog::warn("{} of {} ranks have no particles at the start: fewer blocks of 2 cells per direction have liquid", idle,
               all_ranks()->size());
}

void warn_of_rejection(const Clock& clock, const std::string& why) {
  spdlog::warn("step {} from t = {:.6g} s with dt = {:.6g} s is taken back: {}", clock.index + 1, clock.time,
               clock.step, why);
}

/// Sound runs stay below: the scenes of this repository gain up to 0.9 %.
void warn_of_energy(const Json& summary, World& world) {
  const double rise = summary["conservation"]["energy_rise"];
  if (rise <= 0.01) return;
  const EnergyWatch& energy = totals_of_all_rows(world).energy;
  world.resource<Warnings>().add(
      "energy",
      fmt::format(
          "energy rose by {:.3g} % of what was exchanged, {:.3g} J that no work accounts for, most of all until "
          "t = {:.6g} s; a shorter step or another method may keep it",
          100 * rise, energy.gain(), energy.time));
}

/// Sound runs stay below: a step turns over now and then, alone; after an impact 48 and more do with gamma = 0.5, 26
/// with gamma = 0.55. (E122)
void warn_of_turns(World& world) {
  if (!world.has<Turns>()) return;
  const std::int64_t longest = world.resource<Turns>().longest;
  if (longest <= 30) return;
  world.resource<Warnings>().add(
      "pressure turns", fmt::format("pressure turned over from step to step, {} times in a row: newmark with gamma = "
                                    "0.5 damps no such oscillation; gamma = 0.6 or the midpoint rule has none that "
                                    "lasts",
                                    longest));
}

/// The rows that count, and nothing after them, whatever became of the last.
void close_history(const fs::path& folder, World& world) {
  world.resource<HistoryFile>().file.close();
  std::error_code ignored;
  if (fs::exists(folder / "history.csv", ignored)) {
    cut_history((folder / "history.csv").string(), totals_of_all_rows(world).rows);
  }
}

/// A system after the history, or next to it, has rejected the step.
void take_back_rejected_row(World& world) {
  HistoryFile& history = world.resource<HistoryFile>();
  history.extra.reset();
  if (history.rows > world.resource<RunTotals>().rows) take_back_row(history);
}

}  // namespace

RunResult run_into_folder(const SceneFile& file, const RunPlan& plan, Profiler& profiler,
                          const std::atomic<bool>& stop) {
  const Stopwatch stopwatch;
  const Scene& scene = file.scene;
  World world;
  seed(scene, plan.scene, world);
  if (plan.beginning == Beginning::start) warn_of_scene(scene, plan.scene, world);
  if (plan.beginning == Beginning::start && !plan.quiet) tell_of_creep(scene, plan.scene, world);
  Pipeline pipeline = make_pipeline(scene);
  if (all_ranks() != nullptr) require_fit_for_ranks(pipeline, plan.scene);
  // One thread has nobody to share a graph with.
  const Execution execution = all_ranks() != nullptr ? Execution::ranks
                              : plan.threads == 1    ? Execution::list
                                                     : Execution::graph;
  Schedule start(std::move(pipeline.start), world, nullptr, execution);
  Schedule step(std::move(pipeline.step), world, &profiler, execution);
  Schedule frame(std::move(pipeline.output), world, &profiler, execution);
  TimePlan times = make_time_plan(scene);
  times.max_steps = plan.steps;
  RunResult result;
  FolderClaim claim;
  if (!begin_output(plan, file, times, world, claim)) {
    result.clock = world.resource<Clock>();
    result.was_over = true;
    return result;
  }
  if (plan.beginning == Beginning::continuation) result.checkpoint = world.resource<Clock>();
  warn_of_idle_ranks(world);
  Progress progress(times, world.resource<Clock>(), plan.quiet || !writes_for_all());
  const std::int64_t all_at_start = sum_over_ranks(static_cast<std::int64_t>(world.rows<Particles>()));
  const auto particles = [&] {  // of ranks the first cannot ask the others in passing
    return all_ranks() != nullptr ? static_cast<std::size_t>(all_at_start) : world.rows<Particles>();
  };
  MemoryReserve reserve;
  const Observers observers{
      .after_step = [&](const Clock& clock) { progress.show(clock, particles(), world.resource<SolveReport>()); },
      .after_rejection =
          [&](const Clock& clock, const std::string& why) {
            warn_of_rejection(clock, why);
            if (writes_for_all()) take_back_rejected_row(world);
          },
      .write_checkpoint =
          [&] {
            reserve.release();
            write_run_checkpoint(plan.folder, file, world);
            result.checkpoint = world.resource<Clock>();
            reserve.take();
          }};
  const Stopwatch loop;
  result.outcome = run_simulation(world, start, step, frame, times, observers, stop, plan.beginning);
  result.loop_seconds = loop.wall_seconds();
  result.loop_cpu_seconds = loop.cpu_seconds();
  progress.end();

  if (writes_for_all()) close_history(plan.folder, world);
  result.clock = world.resource<Clock>();
  result.summary = make_summary(plan.scene, result.outcome, plan.threads, times.end, stopwatch, profiler, world);
  warn_of_energy(result.summary, world);
  warn_of_turns(world);
  result.summary["warnings"] = world.resource<Warnings>().texts();
  if (writes_for_all()) write_summary(plan.folder, result);
  if (plan.at_end && result.outcome.ending == Ending::done) plan.at_end(world);
  return result;
}

}  // namespace minamo
