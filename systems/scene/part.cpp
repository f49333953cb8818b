#include "systems/scene/part.hpp"

#include "systems/scene/scene.hpp"

#include <algorithm>

namespace minamo {

const std::vector<Slot>& slots() {
  static const std::vector<Slot> all{
      {"configure", "where the step takes its weights"},
      {"sort", "particles by cell; faces and multipliers, or nodes, get rows"},
      {"p2g", "particles to grid: mass, velocity"},
      {"boundaries", "what walls and openings prescribe"},
      {"predict", "velocity without pressure; equal order: as a function of the displacement"},
      {"forces", "body force per unit mass on the grid"},
      {"ballistic", "equal order: nodes that only forces move"},
      {"material", "how full the grid is, inertia, viscosity"},
      {"assemble", "matrices of momentum and continuity, to which every term adds"},
      {"right_hand_side", "known terms of momentum and continuity, to which every term adds"},
      {"solve", "pressure and velocity, or displacement"},
      {"correct", "velocity of the grid at the end of the step"},
      {"g2p", "grid to particles: velocity"},
      {"advect", "particles move"},
      {"volume", "particles are kept apart"},
      {"accept", "the step is accepted or rejected"},
      {record_slots, "what goes into the history"},
      {"record", "the history"},
  };
  return all;
}

void Recipe::add(std::string_view slot, System system, When when) {
  const auto known = std::find_if(slots().begin(), slots().end(), [&](const Slot& s) { return s.name == slot; });
  if (known == slots().end()) throw std::logic_error("there is no slot \"" + std::string(slot) + "\"");
  const bool is_there = std::any_of(placed_.begin(), placed_.end(), [&](const Placed& placed) {
    return placed.slot == slot && placed.when == when && placed.system.name == system.name;
  });
  if (!is_there) placed_.push_back({known->name, when, std::move(system)});
}

void Recipe::add(std::string_view slot, const std::string& system, When when) { add(slot, make(system), when); }

void Recipe::fill(const std::string& row, const std::vector<std::string>& systems) {
  std::vector<System> made;
  for (const std::string& system : systems) made.push_back(make(system));
  fill(row, std::move(made));
}

void Recipe::add_standing_step(const std::string& configure, std::vector<System> after) {
  standing_.push_back({make(configure), std::move(after)});
}

const SystemRegistry& registry_of(const Scene& scene) { return scene.recipe.registry(); }

void note_scheme(Scene& scene, const std::string& part, const std::string& scheme) { scene.schemes[part] = scheme; }

}  // namespace minamo
