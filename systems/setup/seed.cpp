#include "systems/setup/seed.hpp"

namespace minamo {

void seed_world(const Scene& scene, const std::string& file, World& world) {
  SeedProblems problems{file, {}};
  for (const Seed& seed : scene.recipe.seeds()) seed(scene, world, problems);
  if (!problems.problems.empty()) throw InputError(std::move(problems.problems));
}

}  // namespace minamo
