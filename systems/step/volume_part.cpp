#include "components/fluid.hpp"
#include "components/step.hpp"
#include "systems/equal_order/delta_correction.hpp"
#include "systems/equal_order/limit_shift.hpp"
#include "systems/equal_order/volume_projection.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/step/memory.hpp"
#include "systems/volume/face_volume.hpp"

namespace minamo {

namespace {

Contribution read_projection(Input& input, Scene&) {
  const VolumeRate rate{input.number("rate", {.doc = "share of the excess that is corrected in a step",
                                              .fallback = VolumeRate{}.rate,
                                              .at_most = 1,
                                              .above = 0})};
  return [rate](const Scene& scene, Recipe& recipe) {
    recipe.constant(rate);
    if (is_conforming(scene)) recipe.constant(StirGrid{fewest_per_cell(scene)});
  };
}

}  // namespace

void add_volume(SystemRegistry& registry) {
  registry.add<GatherNodeVolume>("gather_node_volume");
  registry.add<FindVolumeExcess>("find_volume_excess");
  registry.add<FillVolumeSource>("volume_source");
  registry.add<UnpackShift>("unpack_shift");
  registry.add<StoreKineticEnergy>("store_kinetic_energy", OnRanks::own);
  registry.add<LimitShift>("limit_shift");
  registry.add<ShiftParticles>("shift_particles");
  registry.add<ShiftByDelta>("shift_by_delta");
  registry.add(VolumeCorrection{{"delta", "pushes particles apart where they overlap", {}}});
  registry.add(VolumeCorrection{{"none", "no correction", {}}});
  registry.add(VolumeCorrection{
      {"projection", "closes gaps and pushes apart, with the operators of the step", read_projection}});
  registry.add(choice<VolumeCorrection>("volume", "volume correction", always("projection")));
}

}  // namespace minamo
