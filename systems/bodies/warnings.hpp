#pragma once
/// \file
/// What a scene with bodies may not mean: gaps too thin for the grid, bodies that overlap others at the start,
/// liquid that bodies take the place of, thin walls between liquid and liquid.

#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// A sentence each. Gaps are those between two bodies, or a body and a side of the grid, that are thinner than two
/// cells and open all along; where walls meet at an angle or bodies touch is none.
/// \pre the world was seeded with the scene
std::vector<std::string> warnings_of_bodies(const Scene& scene, World& world);

}  // namespace minamo
