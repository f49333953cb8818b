#pragma once
/// \file
/// Fills a world with what a scene measures: ode variables, exact solution, probes.

#include "components/instant.hpp"
#include "engine/world.hpp"
#include "systems/setup/scene.hpp"

namespace minamo {

/// t = 0 and the start values of the ode variables.
Instant start_of(const Scene& scene);

/// Creates the components that the scene needs, and no others. Rates and exact fields that are not finite at the start
/// are added to `problems`.
/// \pre the particles are seeded.
template <int Dim>
void seed_measure(const Scene& scene, const std::string& file, World& world, std::vector<Problem>& problems);

}  // namespace minamo
