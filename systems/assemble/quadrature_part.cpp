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

void set_places(Scene& scene, LatticePlaces of_equal_order) {
  scene.facts.set(is_conforming(scene) ? places_of(scene.facts.get<Discretization>()) : of_equal_order);
}

Contribution read_mixed(Input&, Scene& scene) {
  set_places(scene, LatticePlaces::nearer_to_walls);
  return adds_systems("assemble", {{"find_filled_nodes", "moments"}, {"find_mobility_mixed"}});
}

/// What has masses of faces or forces at the surface of its own.
void check_exact_at_surface(const Scene& scene, SeedProblems& problems) {
  const auto note = [&](const char* what) {
    problems.note("/quadrature/scheme", "not with this scene", R"("mixed")", std::string(R"("exact" with )") + what);
  };
  if (!is_conforming(scene)) note("equal_order");
  if (scene.facts.find<BodiesOfScene>()) note("bodies");
  if (scene.facts.find<SurfaceTension>()) note("surface_tension");
}

Contribution read_exact_at_surface(Input&, Scene& scene) {
  set_places(scene, LatticePlaces::nearer_to_walls);
  return [](const Scene& of, Recipe& recipe) {
    recipe.seed([](const Scene& seeded, World&, SeedProblems& problems) { check_exact_at_surface(seeded, problems); });
    add_systems(of, recipe, "assemble", {{"find_filled_nodes", "moments"}, {"find_mobility_mixed"}});
    if (is_conforming(of)) add_exact_pressure(recipe);
  };
}

Contribution read_particles(Input&, Scene& scene) {
  set_places(scene, LatticePlaces::middle_of_parts);
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
  registry.add(
      Quadrature{{"exact", "mixed, and at the surface of a liquid nearly at rest pressure meets exact integrals",
                  read_exact_at_surface}});
  registry.add(Quadrature{{"particles", "by particles alone", read_particles}});
  registry.add(choice<Quadrature>("quadrature", "integrals of the balances", always("mixed")));
}

}  // namespace minamo
