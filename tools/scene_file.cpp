#include "tools/scene_file.hpp"

#include "systems/setup/seed.hpp"

#include <filesystem>

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
  Input::Document document(json, std::filesystem::path(path).filename());
  SceneFile file{read_scene(document.root(), registry), {}};
  document.finish();
  problems.insert(problems.end(), document.problems().begin(), document.problems().end());
  if (!problems.empty()) throw InputError(std::move(problems));
  file.as_run = document.echo();
  return file;
}

void seed(const Scene& scene, const std::string& file, World& world) {
  const std::string name = std::filesystem::path(file).filename();
  if (scene.dimension == 2) {
    seed_world<2>(scene, name, world);
  } else {
    seed_world<3>(scene, name, world);
  }
}

}  // namespace minamo
