#pragma once
/// \file
/// From a scene file to a run that is ready to start.

#include "systems/pipeline.hpp"
#include "systems/setup/scene.hpp"

#include <string>
#include <vector>

namespace minamo {

struct SceneFile {
  Scene scene;
  Json as_run;  ///< with defaults and overrides filled in; reads as the same scene
};

/// \throws InputError with all problems of the file.
SceneFile load_scene(const std::string& path, const std::vector<std::string>& overrides,
                     const SystemRegistry& registry);

/// seed_world() for the dimension of the scene. \throws InputError
void seed(const Scene& scene, const std::string& file, World& world);

}  // namespace minamo
