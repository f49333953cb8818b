#include "systems/measure/conservation.hpp"
#include "systems/measure/volume.hpp"
#include "systems/parts.hpp"

namespace minamo {

void add_conservation(SystemRegistry& registry) {
  registry.add<MeasureEnergy>("measure_energy");
  registry.add<MeasureMomentum>("measure_momentum");
  registry.add<MeasureMaxSpeed>("measure_max_speed");
  registry.add<MeasureDivergence>("measure_divergence");
  registry.add<MeasureOverlap>("measure_overlap");
  registry.add(Part{
      "conservation", "energy, momentum, divergence and overlap in the history; no key", [](Input&, Scene&) {
        return [](const Scene&, Recipe& recipe) {
          for (const char* system : {"gather_node_volume", "find_advected_capacity", "measure_overlap"})
            recipe.add("accept", system);
          for (const char* system : {"measure_energy", "measure_momentum", "measure_max_speed", "measure_divergence"})
            recipe.add("measure", system);
        };
      }});
}

}  // namespace minamo
