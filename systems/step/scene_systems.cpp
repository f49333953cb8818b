#include "systems/step/scene_systems.hpp"

#include "engine/schedule/schedule.hpp"
#include "systems/step/pipeline.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

using Lines = std::vector<std::string>;

Lines complaints(const Scene& scene) { return unwritten_reads(make_pipeline(scene).step); }

/// What the step lacks with the extra system and does not lack without it.
Lines due_to(const Lines& with, const Lines& without) {
  Lines due;
  std::copy_if(with.begin(), with.end(), std::back_inserter(due), [&](const std::string& line) {
    return std::find(without.begin(), without.end(), line) == without.end();
  });
  return due;
}

/// The problem of extra system `i`.
Problem problem(const Scene& scene, std::size_t i, const Lines& due, const Lines& without) {
  std::vector<std::string> fitting;
  Scene moved = scene;
  for (const Slot& slot : slots()) {
    moved.systems[i].after = slot.name;
    if (due_to(complaints(moved), without).empty()) fitting.emplace_back(slot.name);
  }
  const ExtraSystem& extra = scene.systems[i];
  const std::string what = due.size() == 1 ? due[0] : fmt::format("{}; {} more like this", due[0], due.size() - 1);
  if (fitting.empty()) {
    return {{},
            fmt::format("/systems/{}/use", i),
            what,
            "a system that reads what the step of this scene writes",
            shown(extra.system.name),
            {}};
  }
  return {{}, fmt::format("/systems/{}/after", i), what, one_of_text(fitting), shown(extra.after), {}};
}

}  // namespace

std::vector<Problem> misplaced_systems(const Scene& scene, const std::string& file) {
  std::vector<Problem> problems;
  const Lines with = complaints(scene);
  for (std::size_t i = 0; i < scene.systems.size() && !with.empty(); ++i) {
    Scene others = scene;
    others.systems.erase(others.systems.begin() + static_cast<std::ptrdiff_t>(i));
    const Lines without = complaints(others);
    const Lines due = due_to(with, without);
    if (due.empty()) continue;
    problems.push_back(problem(scene, i, due, without));
    problems.back().file = file;
  }
  return problems;
}

}  // namespace minamo
