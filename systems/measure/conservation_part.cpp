#include "systems/bodies/bodies_part.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/measure/volume.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"

namespace minamo {

void add_conservation(SystemRegistry& registry) {
  registry.add<MeasureEnergy>("measure_energy");
  registry.add<MeasureMomentum>("measure_momentum");
  registry.add<MeasureMaxSpeed>("measure_max_speed");
  registry.add<MeasureDivergence>("measure_divergence");
  registry.add<MeasureOverlap>("measure_overlap");
  registry.add(
      Part{"conservation", "energy, momentum, divergence and overlap in the history; no key", [](Input&, Scene&) {
             return [](const Scene& of, Recipe& recipe) {
               add_systems(of, recipe, "accept",
                           {{"gather_node_volume", "find_advected_capacity", "measure_overlap"},
                            {"measure_multiplier_overlap"}});
               for (const char* system : {"measure_energy", "measure_momentum", "measure_max_speed"}) {
                 recipe.add("measure", system);
               }
               // Beside bodies it is measured in the slot of the solve, before velocities are extended to closed faces.
               if (!of.facts.find<BodiesOfScene>())
                 add_systems(of, recipe, "measure", {{"measure_divergence"}, {"measure_face_divergence"}});
             };
           }});
}

}  // namespace minamo
