#include "tools/program/commands.hpp"

#include "engine/storage/text_file.hpp"
#include "tools/program/interrupt.hpp"
#include "tools/program/machine.hpp"
#include "tools/program/results_folder.hpp"
#include "tools/program/single_run.hpp"
#include "tools/program/study_others.hpp"
#include "tools/program/study_picture.hpp"
#include "tools/program/study_table.hpp"
#include "tools/program/study_variant.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

namespace minamo {

namespace {

namespace fs = std::filesystem;

fs::path output_folder(const StudyOptions& options) {
  return options.out.empty() ? fs::path("out/studies") / fs::path(options.study).stem() : fs::path(options.out);
}

constexpr std::array<const char*, 3> results{"study.csv", "study.png", "others.csv"};

/// Makes the folder, without what an earlier study left in it in addition to the folders of its variants.
/// \param inputs  that must stay
FolderClaim open_output(const fs::path& folder, const std::vector<fs::path>& inputs) {
  make_output_folder(folder);
  FolderClaim claim(folder);
  require_kept(inputs, folder, results);
  for (const char* name : results) {
    std::error_code error;
    fs::remove(folder / name, error);
    if (error) refuse_folder(folder, fmt::format("{} cannot be removed: {}", name, error.message()));
  }
  return claim;
}

/// So that problems are told before the first run. \throws InputError
void require_others(const Study& study) {
  if (study.others.empty()) return;
  if (!fs::exists(study.others)) {
    throw InputError({{study.file,
                       "/others",
                       "no such file",
                       "a table of points of others, from the folder of the study",
                       shown(Json(study.others)),
                       {}}});
  }
  read_others(study.others);
}

/// The files of a study in addition to those that its scene refers to.
std::vector<fs::path> inputs_of(const Study& study) {
  std::vector<fs::path> inputs{study.file, study.scene};
  if (!study.others.empty()) inputs.emplace_back(study.others);
  if (const auto* program = std::get_if<ErrorOfProgram>(&study.error)) inputs.emplace_back(program->program);
  return inputs;
}

StudyTable empty_table(const Study& study, int threads) {
  StudyTable table;
  table.heads = short_names(study.parameters);
  for (const Parameter& parameter : study.parameters) {
    if (parameter.key == resolution_key) table.resolution_at = table.keys.size();
    table.keys.push_back(parameter.key);
  }
  table.cpu_model = cpu_model();
  table.threads = threads;
  table.cost = study.cost;
  return table;
}

struct FinishedVariant {
  StudyRow row;                     ///< without its error
  std::optional<FinishedRun> left;  ///< none where the run is not done
};

/// Runs a variant. What goes wrong in it is a row as well.
FinishedVariant run_variant(const Variant& variant, const RunPlan& general, const std::atomic<bool>& stop) {
  StudyRow row{.values = variant.values, .resolution = variant.resolution, .error = {}, .status = "failed"};
  try {
    double farthest = 0;
    RunPlan plan = general;
    plan.folder /= variant.name;
    plan.at_end = [&](World& world) { farthest = farthest_distance(world, variant.scene.scene.dimension); };
    Profiler profiler;
    const RunResult result = run_into_folder(variant.scene, plan, profiler, stop);
    row.time_step = variant.scene.scene.time.step.value_or(result.clock.step);
    row.wall_seconds = result.loop_seconds;
    row.cpu_seconds = result.loop_cpu_seconds / result.clock.time;
    row.steps = result.clock.index;
    row.particles = result.summary.at("particles").get<std::int64_t>();
    row.unknowns_max = result.summary.at("unknowns_max").get<std::int64_t>();
    row.status = result.summary.at("status").get<std::string>();
    if (result.outcome.ending == Ending::failed) spdlog::error("{}: {}", variant.name, result.outcome.message);
    if (result.outcome.ending == Ending::done) return {row, FinishedRun{plan.folder, result.summary, farthest}};
  } catch (const std::exception& failure) {
    spdlog::error("{}: {}", variant.name, failure.what());
  }
  return {row, {}};
}

StudyRow run_and_measure(const Study& study, const Variant& variant, const RunPlan& plan,
                         const std::atomic<bool>& stop) {
  auto [row, left] = run_variant(variant, plan, stop);
  if (!left) return row;
  try {
    row.error = error_of(study.error, *left);
    if (!row.error) spdlog::error("{}: the error is not a finite number", variant.name);
  } catch (const std::exception& failure) {
    spdlog::error("{}: {}", variant.name, failure.what());
    row.status = "failed";
  }
  return row;
}

/// What disturbs a run only makes it slower. The bits are the same, so the error is.
void run_again(StudyRow& row, const Variant& variant, const RunPlan& plan, const std::atomic<bool>& stop) {
  const auto [again, left] = run_variant(variant, plan, stop);
  if (!left) return;
  row.wall_seconds = std::min(row.wall_seconds, again.wall_seconds);
  row.cpu_seconds = std::min(row.cpu_seconds, again.cpu_seconds);
}

std::string one_line(const StudyTable& table, const StudyRow& row) {
  if (!row.error) return row.status;
  return fmt::format("error {:.3e}, {:.3g} s, {} steps", *row.error, cost_of(table, row), row.steps);
}

std::string cost_label(const StudyTable& table) {
  return fmt::format("{}, {} {} of {}", table.cost == Cost::wall ? "wall: time loop" : "cpu: of a simulated second",
                     table.threads, table.threads == 1 ? "thread" : "threads", table.cpu_model);
}

/// What others need for the same error, printed and written.
void compare_with_others(const Study& study, const StudyTable& table, const fs::path& folder, bool quiet) {
  if (study.others.empty()) return;
  const std::vector<AtEqualError> pairs = at_equal_error(table, read_others(study.others));
  write_text(folder / "others.csv", as_csv(table, pairs));
  if (!quiet) std::cout << as_text(table, pairs) << std::flush;
}

int report(const Study& study, const StudyTable& table, std::size_t variants, const fs::path& folder, bool quiet) {
  const bool interrupted = table.rows.size() < variants || table.rows.back().status == "interrupted";
  const auto finished =
      std::count_if(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.status == "done"; });
  if (!quiet) {
    if (!study.title.empty()) std::cout << study.title << '\n';
    std::cout << as_text(table) << "error: " << error_label(study.error) << "; " << cost_label(table)
              << "\nfrontier: no other variant is both faster and more accurate" << std::endl;
  }
  compare_with_others(study, table, folder, quiet);
  const bool has_error =
      std::any_of(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.error > 0.0; });
  const bool drawn =
      has_error && draw_study(folder / "study.csv", {study.title, error_label(study.error), study.cost, study.others});
  if (!quiet) spdlog::info("results in {}: study.csv{}", folder.string(), drawn ? ", study.png" : "");
  if (interrupted) spdlog::warn("interrupted after {} of {} variants", finished, variants);
  if (interrupted) return exit_interrupted;
  return finished > 0 ? exit_done : exit_failed;
}

/// All variants in turn, as often as the study wants: what else the machine does falls on all of them alike.
void repeat_runs(const Study& study, const std::vector<Variant>& variants, const RunPlan& plan, StudyTable& table,
                 const std::atomic<bool>& stop) {
  for (int pass = 1; pass < study.repeats; ++pass) {
    for (std::size_t k = 0; k < table.rows.size() && !stop; ++k) {
      if (table.rows[k].error) run_again(table.rows[k], variants[k], plan, stop);
    }
    write_text(plan.folder / "study.csv", as_csv(table));
    if (!plan.quiet && !stop) spdlog::info("run {} of {} of every variant", pass + 1, study.repeats);
  }
}

}  // namespace

int run_study(const StudyOptions& options, const SystemRegistry& registry) {
  const Study study = read_study(options.study);
  require_others(study);
  const std::vector<Variant> variants = make_variants(study, registry);
  const fs::path folder = output_folder(options);
  const std::vector<fs::path> inputs = inputs_of(study);
  const FolderClaim claim = open_output(folder, inputs);
  const int threads = prepare_threads(options.threads);
  const RunPlan plan{.scene = study.scene,
                     .folder = folder,
                     .inputs = inputs,
                     .threads = threads,
                     .steps = {},
                     .replaced = Replaced::own_runs,
                     .quiet = options.quiet,
                     .at_end = {}};
  const std::atomic<bool>& stop = stop_on_signal();
  StudyTable table = empty_table(study, threads);
  for (const Variant& variant : variants) {
    if (stop) break;
    table.rows.push_back(run_and_measure(study, variant, plan, stop));
    // After every variant, so that a study that is cut off leaves what it has.
    write_text(folder / "study.csv", as_csv(table));
    if (options.quiet) continue;
    spdlog::info("{}/{} {}: {}", table.rows.size(), variants.size(), variant.name, one_line(table, table.rows.back()));
  }
  repeat_runs(study, variants, plan, table, stop);
  return report(study, table, variants.size(), folder, options.quiet);
}

}  // namespace minamo
