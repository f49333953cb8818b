#include "tools/program/continuation.hpp"

#include "engine/run/communicator.hpp"
#include "engine/run/step_control.hpp"
#include "engine/storage/checkpoint.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/output/surface/surface_folder.hpp"
#include "systems/ranks/rows_of_ranks.hpp"

#include "minamo_version.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

namespace fs = std::filesystem;

constexpr const char* checkpoint_name = "checkpoint.h5";

/// What the checkpoint holds in addition to the state: scene, version, where the files of frames end.
namespace dataset {
constexpr const char* scene = "/scene";
constexpr const char* version = "/version";
constexpr const char* frames = "/fields/frames";
}  // namespace dataset

Problem problem(const fs::path& file, std::string what, std::string expected, std::string got) {
  return {file.string(), {}, std::move(what), std::move(expected), std::move(got), {}};
}

/// Whether a continuation may have another value there.
bool may_change(const std::string& pointer) {
  return pointer == "/title" || pointer == "/$schema" || pointer == "/time/end" || pointer.starts_with("/output/");
}

/// A problem per value of the scene that the checkpoint was not made with.
std::vector<Problem> differences(const std::string& scene_path, const Json& stored, const Json& scene) {
  const Json before = stored.flatten();
  const Json now = scene.flatten();
  const auto text = [](const Json& values, const std::string& pointer) {
    return values.contains(pointer) ? shown(values[pointer]) : std::string("nothing");
  };
  Json pointers = before;
  pointers.update(now);
  std::vector<Problem> problems;
  for (const auto& [pointer, value] : pointers.items()) {
    if (may_change(pointer) || text(before, pointer) == text(now, pointer)) continue;
    problems.push_back({scene_path,
                        pointer,
                        "differs from the scene of the checkpoint",
                        text(before, pointer),
                        text(now, pointer),
                        {}});
  }
  return problems;
}

Problem no_checkpoint(const fs::path& path) {
  return problem(path, "is no checkpoint", "a file that minamo has written", {});
}

/// \throws InputError if there is none.
Hdf5File open_checkpoint(const fs::path& path) {
  if (!fs::exists(path)) {
    throw InputError({problem(path, "no such checkpoint",
                              "one that an earlier run has left; without --resume a run starts anew", {})});
  }
  try {
    return Hdf5File(path.string(), Hdf5File::Access::read);
  } catch (const std::runtime_error&) {
    throw InputError({no_checkpoint(path)});
  }
}

void require_fit(const Hdf5File& file, const std::string& scene_path, const SceneFile& scene) {
  for (const char* name : {dataset::version, dataset::scene, dataset::frames}) {
    if (!file.has(name)) throw InputError({no_checkpoint(file.path())});
  }
  const std::string written_by = file.read_text(dataset::version);
  if (written_by != version) {
    throw InputError(
        {problem(file.path(), "was written by another version of minamo", std::string(version), written_by)});
  }
  std::vector<Problem> problems = differences(scene_path, Json::parse(file.read_text(dataset::scene)), scene.as_run);
  if (!problems.empty()) throw InputError(std::move(problems));
}

void require_output(const fs::path& folder, const FieldsPosition& fields) {
  const std::string misfit = misfit_of_fields(folder.string(), fields);
  if (misfit.empty()) return;
  const auto space = misfit.find(' ');
  throw InputError(
      {problem(folder / misfit.substr(0, space), misfit.substr(space + 1), "what the run had written until then", {})});
}

/// Takes the history back. \throws InputError if it does not reach to the checkpoint.
void open_history(const fs::path& path, std::int64_t rows, HistoryFile& history) {
  const std::int64_t found = fs::exists(path) ? cut_history(path.string(), rows) : 0;
  if (found < rows) {
    throw InputError({problem(path, "is missing, or ends before the checkpoint", fmt::format("at least {} rows", rows),
                              fmt::format("{} rows", std::max<std::int64_t>(found, 0)))});
  }
  history.path = path.string();
  history.file.open(path, std::ios::app);
}

/// Nothing is begun, and the rows that the checkpoint counts are in the file.
void settle_output(const fs::path& folder, World& world) {
  FieldsFile& fields = world.resource<FieldsFile>();
  if (take_back_frame(fields)) remove_surfaces(folder, fields.frames);
  flush(world.resource<HistoryFile>());
}

}  // namespace

void write_run_checkpoint(const fs::path& folder, const SceneFile& scene, World& world) {
  Communicator* ranks = all_ranks();
  do_on_all(ranks, [&] {
    if (writes_for_all()) settle_output(folder, world);
  });
  const auto add = [&](Hdf5File& file) {
    file.write_text(dataset::scene, scene.as_run.dump());
    file.write_text(dataset::version, std::string(version));
    file.write_text(dataset::frames, Json(position_of(world.resource<FieldsFile>())).dump());
  };
  write_checkpoint((folder / checkpoint_name).string(), world, add,
                   ranks == nullptr ? RowsOfRank{} : rows_of_rank(*ranks, world));
}

FieldsPosition load_checkpoint(const fs::path& folder, const std::string& scene_path, const SceneFile& scene,
                               World& world) {
  const Hdf5File file = open_checkpoint(folder / checkpoint_name);
  require_fit(file, scene_path, scene);
  const FieldsPosition fields = Json::parse(file.read_text(dataset::frames)).get<FieldsPosition>();
  require_output(folder, fields);
  world.resource<StepControl>();  // no system names it; the time loop makes it, later
  const Communicator* ranks = all_ranks();
  read_state(file, world, ranks == nullptr ? ShareOfTable{} : share_of_rank(*ranks));
  return fields;
}

void continue_output(const fs::path& folder, const FieldsPosition& stored, World& world) {
  open_history(folder / "history.csv", world.resource<RunTotals>().rows, world.resource<HistoryFile>());
  continue_fields(world.resource<FieldsFile>(), folder.string(), stored);
  remove_surfaces(folder, stored.frames);
}

}  // namespace minamo
