#pragma once
/// \file
/// The discretization of a scene. Parts whose systems depend on it name those of both.

#include "systems/scene/scene.hpp"

namespace minamo {

/// Equal order: velocity and pressure on the nodes of the grid, stabilized. Conforming: velocities on faces, free of
/// divergence at every point.
struct Discretization {
  bool is_conforming = false;
  int degree = 2;  ///< of the splines of conforming velocities along themselves
};

/// False also where its name is unknown: that problem is noted, and the rest of the scene is still read.
inline bool is_conforming(const Scene& scene) {
  const auto* discretization = scene.facts.find<Discretization>();
  return discretization != nullptr && discretization->is_conforming;
}

/// Systems of a slot, by discretization.
struct SystemsOf {
  std::vector<std::string> equal_order;
  std::vector<std::string> conforming;
};

inline void add_systems(const Scene& scene, Recipe& recipe, std::string_view slot, const SystemsOf& systems,
                        When when = When::always) {
  for (const std::string& system : is_conforming(scene) ? systems.conforming : systems.equal_order) {
    recipe.add(slot, system, when);
  }
}

/// A contribution that adds the systems of the scene's discretization to a slot.
inline Contribution adds_systems(std::string_view slot, SystemsOf systems) {
  return [slot, systems = std::move(systems)](const Scene& scene, Recipe& recipe) {
    add_systems(scene, recipe, slot, systems);
  };
}

}  // namespace minamo
