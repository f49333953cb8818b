#include "systems/contact/loop.hpp"
#include "systems/contact/sides.hpp"
#include "systems/contact/surfaces.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"

namespace minamo {

namespace {

Contribution separating_walls(Input&, Scene&) {
  return [](const Scene& scene, Recipe& recipe) {
    if (scene.facts.find<RepeatsBalances>() == nullptr || !is_conforming(scene)) return;
    recipe.fill("<find_contact>", [](std::vector<System> body) {
      return std::vector{make_loop<ContactLoop>("find_contact", std::move(body), most_contact_passes)};
    });
  };
}

}  // namespace

void add_separating(SystemRegistry& registry) {
  registry.add<FindSeparatingFaces>("find_separating_faces", OnRanks::own);
  registry.add<StopOldVelocityAtSides>("stop_old_velocity_at_sides", OnRanks::own);
  registry.add<StartContactOfSides>("start_contact_of_sides", OnRanks::own);
  registry.add<HoldContactOfSides>("hold_contact_of_sides", OnRanks::own);
  registry.add<FindSeparatingRows>("find_separating_rows", OnRanks::own);
  registry.add<FillEmptyFaces>("fill_empty_faces", OnRanks::own);
  registry.add<DetachFromBodies>("detach_from_bodies", OnRanks::own);
  registry.add<StartContactOfBodies>("start_contact_of_bodies", OnRanks::own);
  registry.add<ReleaseFromBodies>("release_from_bodies", OnRanks::own);
  registry.add<CompareContactOfBodies>("compare_contact_of_bodies", OnRanks::adds_up);
  registry.add<FillContactSource>("fill_contact_source", OnRanks::own);
  registry.add<LimitVolumeSourceAtSides>("limit_volume_source_at_sides", OnRanks::own);
  registry.add<CompareContactOfSides>("compare_contact_of_sides", OnRanks::adds_up);
  registry.add<EndContactPass>("end_contact_pass", OnRanks::adds_up);
  registry.add<KeepContactOfSides>("keep_contact_of_sides", OnRanks::own);
  registry.add<StopNewVelocityAtSides>("stop_new_velocity_at_sides", OnRanks::own);
  registry.add<MeasureContact>("measure_contact", OnRanks::alike_on_all);
  registry.add(Part{"separating", "walls that the liquid may leave; no key, \"wall\" and \"walls\" say which",
                    separating_walls});
}

}  // namespace minamo
