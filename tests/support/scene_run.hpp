#pragma once
/// \file
/// A run without files: a scene, its world and its schedules, stepped by hand.

#include "components/particle.hpp"
#include "engine/schedule/schedule.hpp"
#include "systems/step/pipeline.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace minamo::scene_run {

/// A scene from scenes/, by name. Where it leaves its steps to the default, they are 2 ms: a SceneRun chooses none.
Json scene_of_file(const std::string& name);

/// The scene with overrides as on the command line, `/pointer=JSON`.
Json with(Json scene, const std::vector<std::string>& overrides);

/// A measured column of the history after the last step.
double measured(World& world, std::string_view name);

/// The scene with velocity and pressure on the nodes of the grid, for tests of what only that has.
Json of_equal_order(Json scene);

const SystemRegistry& registry();

/// \throws InputError
Scene read(const Json& json);

/// The systems of a step.
std::vector<std::string> step_names(const Json& scene);

/// \pre the scene has a fixed step.
class SceneRun {
 public:
  explicit SceneRun(const Json& json, Execution execution = Execution::graph);
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;

  /// Runs the start of the scene, if that is not done.
  void start();
  /// Steps, after the start.
  void step(int count = 1);
  World& world() { return world_; }
  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
  World world_;
  bool started_ = false;
  Schedule start_;
  Schedule step_;
};

/// A column of the particles in the order of their ids.
template <class C>
std::vector<typename C::value_type> by_id(World& world) {
  const auto id = world.column<particle::Id>();
  const auto column = world.column<C>();
  std::vector<typename C::value_type> sorted(column.begin(), column.end());
  for (std::size_t p = 0; p < id.size(); ++p) sorted[static_cast<std::size_t>(id[p])] = column[p];
  return sorted;
}

/// Of the particles. [kg]
double total_mass(World& world);

/// All components whose lifetime is state, byte for byte.
std::map<std::string, std::vector<std::byte>> state(const World& world);

}  // namespace minamo::scene_run
