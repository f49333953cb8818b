#include "support/scene_run.hpp"

#include "components/measure.hpp"
#include "engine/run/clock.hpp"
#include "systems/step/register.hpp"
#include "tools/program/scene_file.hpp"

#include <numeric>
#include <stdexcept>

namespace minamo::scene_run {

Json scene_of_file(const std::string& name) {
  const std::string folder = std::string(MINAMO_SOURCE_DIR) + "/scenes/";
  Json scene = read_json(folder + name);
  const Json flat = scene.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (pointer.ends_with("/mesh/file")) scene[Json::json_pointer(pointer)] = folder + value.get<std::string>();
  }
  Json& time = scene["time"];
  if (!time.contains("step") && !time.contains("cfl")) time["step"] = 2e-3;
  return scene;
}

Json with(Json scene, const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) set_value(scene, assignment);
  return scene;
}

Json of_equal_order(Json scene) {
  scene["discretization"] = {{"scheme", "equal_order"}};
  return scene;
}

const SystemRegistry& registry() {
  static const SystemRegistry systems = [] {
    SystemRegistry made;
    register_parts(made);
    return made;
  }();
  return systems;
}

Scene read(const Json& json) {
  Input::Document document(json, "scene.json");
  Scene scene = read_scene(document.root(), registry());
  document.finish();
  document.require_valid();
  return scene;
}

std::vector<std::string> step_names(const Json& scene) {
  std::vector<std::string> names;
  for (const System& system : make_pipeline(read(scene)).step) names.push_back(system.name);
  return names;
}

double total_mass(World& world) {
  const auto m_p = world.column<particle::Mass>();
  return std::accumulate(m_p.begin(), m_p.end(), 0.0);
}

namespace {

/// Schedules name components, so the world is seeded before they are made.
World& seeded(const Scene& scene, World& world) {
  seed(scene, "scene.json", world);
  return world;
}

}  // namespace

SceneRun::SceneRun(const Json& json, Execution execution)
    : scene_(read(json)),
      start_(make_pipeline(scene_).start, seeded(scene_, world_), nullptr, execution),
      step_(make_pipeline(scene_).step, world_, nullptr, execution) {}

void SceneRun::start() {
  if (started_) return;
  started_ = true;
  world_.resource<Clock>().step = scene_.time.step.value();
  start_.run();
}

void SceneRun::step(int count) {
  start();
  Clock& clock = world_.resource<Clock>();
  for (int k = 0; k < count; ++k) {
    clock.end_of_step = static_cast<double>(clock.index + 1) * clock.step;
    step_.run();
    clock.time = clock.end_of_step;
    ++clock.index;
  }
}

double measured(World& world, std::string_view name) {
  const double* value = world.resource<measure::Columns>().find(name);
  if (value == nullptr) throw std::runtime_error("no column " + std::string(name));
  return *value;
}

std::map<std::string, std::vector<std::byte>> state(const World& world) {
  std::map<std::string, std::vector<std::byte>> columns;
  for (const auto& [name, storage] : world.components()) {
    if (storage->info().lifetime != Lifetime::state) continue;
    const auto bytes = storage->bytes();
    columns.emplace(name, std::vector<std::byte>(bytes.begin(), bytes.end()));
  }
  return columns;
}

}  // namespace minamo::scene_run
