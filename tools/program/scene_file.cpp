#include "tools/program/scene_file.hpp"

#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/schedule.hpp"
#include "systems/bodies/warnings.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/seeding/seed.hpp"
#include "systems/step/exclusions.hpp"
#include "systems/step/memory.hpp"
#include "systems/step/scene_doubts.hpp"
#include "systems/step/scene_systems.hpp"
#include "systems/step/time_plan.hpp"
#include "systems/surface_tension/capillary_step.hpp"
#include "tools/program/available_memory.hpp"
#include "tools/program/machine.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

/// What this machine has of all that ranks share.
double share_of_machine() {
  const Communicator* ranks = all_ranks();
  return ranks == nullptr ? 1 : static_cast<double>(ranks->on_this_machine()) / ranks->size();
}

std::vector<Problem> memory_problems(const Scene& scene, const std::string& file) {
  const SceneSize size = size_of(scene);
  const bool has_blas = prepare_blas();
  const double needed = share_of_machine() * memory_of(scene, size) + (has_blas ? 0 : blas_work_space);
  const AvailableMemory available = available_memory();
  if (has_blas && needed <= available.bytes) return {};
  std::string what = "does not fit into memory; larger cells or fewer particles per cell need less";
  const std::string& leaner = scene.facts.get<LinearSolver>().leaner;
  if (!leaner.empty()) what += fmt::format(", as does the solver \"{}\"", leaner);
  return {{file,
           {},
           what,
           fmt::format("at most {}, {}", bytes_text(available.bytes), available.source),
           fmt::format("about {}: {:.3g} particles on {:.3g} nodes{}", bytes_text(needed), size.particles, size.nodes,
                       has_blas ? "" : ", and BLAS"),
           {}}};
}

/// The pointer of an override, /pointer=JSON.
std::string pointer_of(const std::string& assignment) { return assignment.substr(0, assignment.find('=')); }

/// What is wrong at or below an overridden pointer is not in the file.
std::vector<Problem> with_overrides_named(std::vector<Problem> problems, const std::vector<std::string>& overrides) {
  for (Problem& problem : problems) {
    for (const std::string& assignment : overrides) {
      const std::string pointer = pointer_of(assignment);
      if (problem.pointer == pointer || problem.pointer.starts_with(pointer + "/"))
        problem.file = "--set " + assignment;
    }
  }
  return problems;
}

void drop_replaced_step(Json& scene, const std::set<std::string>& overridden) {
  if (!scene.is_object() || !scene.contains("time") || !scene["time"].is_object()) return;
  const auto drop = [&](const char* key) {
    if (!overridden.contains(std::string("/time/") + key)) scene["time"].erase(key);
  };
  if (overridden.contains("/time/cfl")) drop("step");
  if (!overridden.contains("/time/step")) return;
  drop("cfl");
  drop("max_step");
}

}  // namespace

void drop_keys_of_replaced_schemes(Json& scene, const std::set<std::string>& overridden,
                                   const SystemRegistry& registry) {
  drop_replaced_step(scene, overridden);
  const auto is_scheme = [](const std::string& pointer) { return pointer.ends_with("/scheme"); };
  if (std::none_of(overridden.begin(), overridden.end(), is_scheme)) return;
  Input::Document document(scene, {});
  read_scene(document.root(), registry);
  document.finish();
  for (const Problem& problem : document.problems()) {
    const auto slash = problem.pointer.rfind('/');
    if (slash == std::string::npos || !problem.what.starts_with("unknown key") ||
        !overridden.contains(problem.pointer.substr(0, slash) + "/scheme") || overridden.contains(problem.pointer)) {
      continue;
    }
    const Json::json_pointer key(problem.pointer);
    scene[key.parent_pointer()].erase(key.back());
  }
}

SceneFile load_scene(const std::string& path, const std::vector<std::string>& overrides,
                     const SystemRegistry& registry) {
  Json json = read_json(path);
  if (json.is_object() && json.contains("scene") && json.contains("vary")) {
    throw InputError({{path, {}, "is a study, not a scene", "a scene; studies are run by `minamo study`", {}, {}}});
  }
  std::vector<Problem> problems;
  std::set<std::string> overridden;
  for (const std::string& assignment : overrides) {
    try {
      set_value(json, assignment);
      overridden.insert(pointer_of(assignment));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  drop_keys_of_replaced_schemes(json, overridden, registry);
  try {
    return understand_scene(json, path, registry, std::move(problems));
  } catch (const InputError& error) {
    throw InputError(with_overrides_named(error.problems(), overrides));
  }
}

SceneFile understand_scene(const Json& json, const std::string& path, const SystemRegistry& registry,
                           std::vector<Problem> problems) {
  Input::Document document(json, path);
  SceneFile file{read_scene(document.root(), registry), {}};
  document.finish();
  problems.insert(problems.end(), document.problems().begin(), document.problems().end());
  if (problems.empty()) problems = exclusions_of(file.scene, path);
  if (problems.empty()) problems = misplaced_systems(file.scene, path);
  if (!problems.empty()) throw InputError(std::move(problems));
  file.scene.remarks = document.remarks();
  file.as_run = document.echo();
  return file;
}

void seed(const Scene& scene, const std::string& file, World& world) {
  agree_on_problems(all_ranks(), memory_problems(scene, file));
  seed_world(scene, file, world);
}

std::vector<std::string> warnings_of(const Scene& scene, World& world) {
  std::vector<std::string> warnings = scene.remarks;
  for (const auto& more :
       {warnings_of_lengths(scene), warnings_of_speeds(scene, world), warnings_of_bodies(scene, world),
        warnings_of_surface_tension(scene), warnings_of_gravity(scene)})
    warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

Rehearsal rehearse(const Scene& scene, const std::string& file) {
  World world;
  const AvailableMemory available = available_memory();
  seed(scene, file, world);
  const Schedule step(make_pipeline(scene).step, world);
  return {world.rows<Particles>(), warnings_of(scene, world), outlook_of(scene, world, available)};
}

}  // namespace minamo
