#include "engine/run/communicator.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/measure/force_work.hpp"
#include "systems/measure/volume.hpp"
#include "systems/measure/watch_lid.hpp"
#include "systems/measure/watch_move.hpp"
#include "systems/measure/watch_volume.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

/// A lid is above: where there is a weight.
void watch_lid(const Scene& scene, Recipe& recipe) {
  const auto& force = scene.facts.get<BodyForce>().of_place_and_time;
  const bool is_constant = std::all_of(force.begin(), force.end(), [](const auto& b) { return b.is_constant(); });
  if (!is_constant || scene.facts.get<BodyForce>().is_zero()) return;
  recipe.add("boundaries", "watch_lid", When::step);
  recipe.seed([force](const Scene& of, World& world, SeedProblems&) {
    with_dimension(of.dimension, [&](auto dim) {
      world.resource<Lids<dim()>>() = lids_of<dim()>(vector_at<dim()>(force, {}), world);
    });
  });
}

VolumeAdvice advice_for(const Scene& scene) {
  VolumeAdvice advice;
  auto& phrases = advice.phrases;
  phrases.push_back(scene.time.step ? fmt::format(R"(a shorter step, "time": {{"step": {:.3g}}})", *scene.time.step / 2)
                                    : fmt::format(R"(shorter steps, "time": {{"cfl": {:.3g}}})", scene.time.cfl / 2));
  if (scene.schemes.at("volume") == "none") phrases.emplace_back(R"("volume": {"scheme": "projection"})");
  if (scene.schemes.at("integrator") == "newmark") phrases.emplace_back(R"("integrator": {"scheme": "midpoint"})");
  if (!is_conforming(scene)) phrases.emplace_back(R"("discretization": {"scheme": "conforming"})");
  if (scene.facts.find<BodiesOfScene>()) phrases.emplace_back("walls of bodies thicker than a cell, or more cells");
  return advice;
}

}  // namespace

void add_conservation(SystemRegistry& registry) {
  registry.add<MeasureEnergy>("measure_energy", OnRanks::adds_up);
  registry.add<MeasureEnergyBalance>("measure_energy_balance", OnRanks::alike_on_all);
  registry.add<BeginEnergyGiven>("begin_energy_given", OnRanks::alike_on_all);
  registry.add<CountForceWork>("count_force_work");
  registry.add<CountFaceForceWork>("count_face_force_work", OnRanks::adds_up);
  registry.add<MeasureMomentum>("measure_momentum", OnRanks::adds_up);
  registry.add<MeasureMaxSpeed>("measure_max_speed", OnRanks::adds_up);
  registry.add<MeasureDivergence>("measure_divergence");
  registry.add<MeasureOverlap>("measure_overlap");
  registry.add<WatchMove>("watch_move", OnRanks::own);
  registry.add<WatchLid>("watch_lid", OnRanks::adds_up);
  registry.add<WatchVolume>("watch_volume", OnRanks::adds_up);
  registry.add(
      Part{"conservation", "energy, momentum, divergence and overlap in the history; no key", [](Input&, Scene&) {
             return [](const Scene& of, Recipe& recipe) {
               watch_lid(of, recipe);
               recipe.constant(advice_for(of));
             };
           }});
}

}  // namespace minamo
