#include "systems/ranks/former_rows.hpp"
#include "systems/ranks/ghost_cells.hpp"
#include "systems/ranks/migrate.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

namespace {

/// A run of one process has nothing of it. Its systems stand with those that they come between: grid/, solve/.
Contribution read_ranks(Input&, Scene&) {
  if (all_ranks() == nullptr) return {};
  return [](const Scene&, Recipe& recipe) {
    recipe.seed([](const Scene& scene, World& world, SeedProblems&) {
      world.resource<Ranks>().all = all_ranks();
      world.resource<ReachOnRanks>();
      send_particles_home(scene.dimension, world);
    });
  };
}

}  // namespace

void add_ranks(SystemRegistry& registry) {
  registry.add<MigrateParticles>("migrate_particles", OnRanks::exchanges);
  registry.add<FindGhostCells>("find_ghost_cells", OnRanks::exchanges);
  registry.add<PlanSiteExchange>("plan_site_exchange", OnRanks::exchanges);
  registry.add<KeepFormerRows>("keep_former_rows", OnRanks::exchanges);
  registry.add<AskForFormerRows>("ask_for_former_rows", OnRanks::exchanges);
  registry.add(Part{"ranks", "a run on several machines; no key", read_ranks});
}

}  // namespace minamo
