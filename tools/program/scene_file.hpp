#pragma once
/// \file
/// From a scene file to a run that is ready to start.

#include "systems/scene/scene.hpp"
#include "systems/step/pipeline.hpp"
#include "tools/program/outlook.hpp"

#include <set>
#include <string>
#include <vector>

namespace minamo {

struct SceneFile {
  Scene scene;
  Json as_run;  ///< with defaults and overrides filled in; reads as the same scene
};

/// Takes out of a block like `transfer`, whose `scheme` is among the overridden pointers, what the file has there for
/// another scheme: with "/transfer/scheme" set to "flip" the "inertia" of "tpic"; and the step that a CFL number
/// replaces, or the other way round. What is overridden itself stays.
void drop_keys_of_replaced_schemes(Json& scene, const std::set<std::string>& overridden,
                                   const SystemRegistry& registry);

/// \throws InputError with all problems of the file.
SceneFile load_scene(const std::string& path, const std::vector<std::string>& overrides,
                     const SystemRegistry& registry);

/// The same for a document that is in memory; `path` is what the messages call it.
/// \param problems  those that are known already.
SceneFile understand_scene(const Json& json, const std::string& path, const SystemRegistry& registry,
                           std::vector<Problem> problems = {});

/// seed_world(), if a run of it fits into memory. \throws InputError
void seed(const Scene& scene, const std::string& file, World& world);

struct Rehearsal {
  std::size_t particles = 0;
  std::vector<std::string> warnings;  ///< what the scene may not mean, a sentence each
  Outlook outlook;
};

/// What a scene may not mean, a sentence each. \pre the world was seeded with it
std::vector<std::string> warnings_of(const Scene& scene, World& world);

/// Makes ready what a run would start with, and lets it go.
/// \throws InputError, ScheduleError
Rehearsal rehearse(const Scene& scene, const std::string& file);

}  // namespace minamo
