#include "tools/program/earlier_run.hpp"

#include "engine/input/problem.hpp"
#include "engine/run/clock.hpp"
#include "engine/storage/hdf5.hpp"
#include "tools/program/results_folder.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cstring>
#include <exception>
#include <fstream>

namespace minamo {

namespace {

namespace fs = std::filesystem;

/// A file as JSON; null if it is not there, or none.
Json json_in(const fs::path& path) {
  std::ifstream file(path);
  const Json json = file ? Json::parse(file, nullptr, false) : Json();
  return json.is_discarded() ? Json() : json;
}

/// A value of that type at a pointer, if there is one.
template <class Value>
std::optional<Value> value_at(const Json& json, const char* pointer) {
  try {
    return json.at(Json::json_pointer(pointer)).get<Value>();
  } catch (const Json::exception&) {
    return {};
  }
}

/// Where the checkpoint is in time, if there is one that can be read.
std::optional<Clock> clock_of_checkpoint(const fs::path& path) {
  if (!fs::exists(path)) return {};
  try {
    const auto bytes = Hdf5File(path.string(), Hdf5File::Access::read).read_bytes("/state/clock");
    Clock clock;
    if (bytes.size() != sizeof(clock)) return {};
    std::memcpy(&clock, bytes.data(), sizeof(clock));
    return clock;
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::string how_it_ended(const std::string& status) { return status == "done" ? "stopped by --steps" : status; }

std::optional<EarlierRun> by_summary(const Json& summary) {
  const auto steps = value_at<std::int64_t>(summary, "/steps");
  const auto time = value_at<double>(summary, "/time");
  const auto status = value_at<std::string>(summary, "/status");
  if (!steps || !time || !status) return {};
  return EarlierRun{.scene = value_at<std::string>(summary, "/scene").value_or(""),
                    .ended = how_it_ended(*status),
                    .time = *time,
                    .end = value_at<double>(summary, "/end"),
                    .steps = *steps,
                    .is_finished = value_at<bool>(summary, "/complete").value_or(*status == "done")};
}

std::optional<EarlierRun> by_checkpoint(const fs::path& folder) {
  const auto clock = clock_of_checkpoint(folder / "checkpoint.h5");
  if (!clock) return {};
  const auto end = value_at<double>(json_in(folder / scene_as_run), "/time/end");
  return EarlierRun{.scene = {},
                    .ended = "ended without a summary, after the checkpoint",
                    .time = clock->time,
                    .end = end,
                    .steps = clock->index,
                    .is_finished = end && clock->time >= *end};
}

bool is_one_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing);
}

}  // namespace

std::optional<EarlierRun> earlier_run(const fs::path& folder) {
  if (auto run = by_summary(json_in(folder / "summary.json"))) return run;
  if (auto run = by_checkpoint(folder)) return run;
  if (!fs::exists(folder / "fields.h5")) return {};
  return EarlierRun{.scene = {}, .ended = {}, .end = {}, .is_finished = true};
}

void refuse_to_replace(const EarlierRun& run, const fs::path& folder) {
  const std::string of = run.scene.empty() ? "" : " of " + run.scene;
  const std::string until = run.end ? fmt::format(" of {:.6g} s", *run.end) : " s";
  throw InputError({{folder.string(),
                     {},
                     "the results of an unfinished run would be replaced",
                     "--resume to go on with it, --overwrite to replace it, or another folder (--out)",
                     fmt::format("a run{}: {} at t = {:.6g}{}", of, run.ended, run.time, until),
                     {}}});
}

void tell_of_replaced(const EarlierRun& run, const fs::path& folder, const std::string& scene, bool quiet) {
  const bool is_same = fs::path(run.scene).lexically_normal() == fs::path(scene).lexically_normal();
  const bool is_its_own = is_one_file(folder / scene_as_run, scene);
  if (!run.scene.empty() && !is_same && !is_its_own && !is_one_file(run.scene, scene)) {
    spdlog::warn("{}: results of {} are replaced", folder.string(), run.scene);
  } else if (!quiet) {
    spdlog::info("{}: the results of {} run are replaced", folder.string(),
                 run.is_worth_keeping() ? "an unfinished" : "an earlier");
  }
}

}  // namespace minamo
