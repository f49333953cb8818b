#include "systems/seeding/seed.hpp"

#include "engine/run/communicator.hpp"

namespace minamo {

void seed_world(const Scene& scene, const std::string& file, World& world) {
  SeedProblems problems{file, {}};
  for (const Seed& seed : scene.recipe.seeds()) seed(scene, world, problems);
  agree_on_problems(all_ranks(), std::move(problems.problems));
}

}  // namespace minamo
