#pragma once
/// \file
/// (E6) The particles of a scene at the start.

#include "systems/scene/parts.hpp"

namespace minamo {

template <int Dim>
void seed_particles(const Scene& scene, World& world, SeedProblems& problems);

}  // namespace minamo
