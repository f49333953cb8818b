#include "tools/scene_file.hpp"

#include "systems/setup/scene_systems.hpp"
#include "systems/setup/seed.hpp"

namespace minamo {

SceneFile load_scene(const std::string& path, const std::vector<std::string>& overrides,
                     const SystemRegistry& registry) {
  Json json = read_json(path);
  std::vector<Problem> problems;
  for (const std::string& assignment : overrides) {
    try {
      set_value(json, assignment);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  return understand_scene(json, path, registry, std::move(problems));
}

SceneFile understand_scene(const Json& json, const std::string& path, const SystemRegistry& registry,
                           std::vector<Problem> problems) {
  Input::Document document(json, path);
  SceneFile file{read_scene(document.root(), registry), {}};
  document.finish();
  problems.insert(problems.end(), document.problems().begin(), document.problems().end());
  if (problems.empty()) problems = misplaced_systems(file.scene, registry, path);
  if (!problems.empty()) throw InputError(std::move(problems));
  file.as_run = document.echo();
  return file;
}

void seed(const Scene& scene, const std::string& file, World& world) {
  if (scene.dimension == 2) {
    seed_world<2>(scene, file, world);
  } else {
    seed_world<3>(scene, file, world);
  }
}

}  // namespace minamo
