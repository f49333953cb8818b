#include "components/surface_tension.hpp"
#include "systems/assemble/moments.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/grid/filled_nodes.hpp"
#include "systems/liquid/exact_pressure.hpp"
#include "systems/liquid/exact_volume.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"
#include "systems/setup/lattice.hpp"
#include "systems/setup/schemes.hpp"

namespace minamo {

namespace {

/// Of faces and multipliers. Those of degree 1 have exact sums on any lattice.
LatticePlaces places_of(const Discretization& conforming) {
  return conforming.degree == 2 ? LatticePlaces::middle_of_parts : LatticePlaces::exact_for_splines;
}

/// Pressure on exact integrals over the liquid.
void add_exact_pressure(Recipe& recipe) {
  for (const char* system : {"find_pressure_acceleration", "find_exact_share", "find_liquid_surface",
                             "find_exact_volume", "add_exact_pressure"})
    recipe.add("assemble", system);
}

Contribution read_mixed(Input&, Scene& scene) {
  scene.facts.set(is_conforming(scene) ? places_of(scene.facts.get<Discretization>()) : LatticePlaces::nearer_to_walls);
  return [](const Scene& of, Recipe& recipe) {
    add_systems(of, recipe, "assemble", {{"find_filled_nodes", "moments"}, {"find_mobility_mixed"}});
    // Bodies have masses of faces of their own; forces of a surface under tension are those of another surface.
    if (is_conforming(of) && !of.facts.find<BodiesOfScene>() && !of.facts.find<SurfaceTension>())
      add_exact_pressure(recipe);
  };
}

Contribution read_particles(Input&, Scene& scene) {
  scene.facts.set(is_conforming(scene) ? places_of(scene.facts.get<Discretization>()) : LatticePlaces::middle_of_parts);
  return adds_systems("assemble", {{"moments"}, {"find_mobility"}});
}

}  // namespace

void add_quadrature(SystemRegistry& registry) {
  registry.add<FindFilledNodes>("find_filled_nodes");
  registry.add<GatherMoments>("moments");
  registry.add<FindLiquidSurface>("find_liquid_surface");
  registry.add<FindExactVolume>("find_exact_volume");
  registry.add<FindPressureAcceleration>("find_pressure_acceleration");
  registry.add<FindExactShare>("find_exact_share");
  registry.add<AddExactPressure>("add_exact_pressure");
  registry.add(Quadrature{{"mixed", "exact inside the liquid, by particles at its surface", read_mixed}});
  registry.add(Quadrature{{"particles", "by particles alone", read_particles}});
  registry.add(choice<Quadrature>("quadrature", "integrals of the balances", always("mixed")));
}

}  // namespace minamo
