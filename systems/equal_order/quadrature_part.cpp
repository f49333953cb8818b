#include "systems/bodies/bodies_part.hpp"
#include "systems/equal_order/moments.hpp"
#include "systems/grid/filled_nodes.hpp"
#include "systems/grid/lattice.hpp"
#include "systems/liquid/exact_pressure.hpp"
#include "systems/liquid/exact_volume.hpp"
#include "systems/liquid/liquid_surface.hpp"
#include "systems/liquid/unseen_liquid.hpp"
#include "systems/ranks/ghost_cells.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Of faces and multipliers. Those of degree 1 have exact sums on any lattice.
LatticePlaces places_of(const Discretization& conforming) {
  return conforming.degree == 2 ? LatticePlaces::middle_of_parts : LatticePlaces::exact_for_splines;
}

void set_places(Scene& scene, LatticePlaces of_equal_order) {
  scene.facts.set(is_conforming(scene) ? places_of(scene.facts.get<Discretization>()) : of_equal_order);
}

Contribution read_mixed(Input&, Scene& scene) {
  set_places(scene, LatticePlaces::nearer_to_walls);
  return {};
}

Contribution read_exact(Input& input, Scene& scene) {
  read_mixed(input, scene);
  if (input.describing() || !is_conforming(scene)) return {};
  return [](const Scene& of, Recipe& recipe) {
    if (of.facts.find<BodiesOfScene>() != nullptr) return;  // (E140) is not asked
    const int sites = sites_to_tellers(of.facts.get<Discretization>().degree);
    recipe.seed([sites](const Scene&, World& world, SeedProblems&) { reach_on_ranks(world, sites); });
  };
}

Contribution read_particles(Input&, Scene& scene) {
  set_places(scene, LatticePlaces::middle_of_parts);
  return {};
}

/// Whether objects of the scene have one of some keys.
bool any_has(const Input& input, const std::vector<std::string>& objects, std::initializer_list<std::string_view> of) {
  return std::any_of(objects.begin(), objects.end(), [&](const std::string& object) {
    const std::vector<std::string> keys = input.names(object);
    return std::find_first_of(keys.begin(), keys.end(), of.begin(), of.end()) != keys.end();
  });
}

/// Where liquid at rest would else begin to move: a body force presses it together, and no yield stress
/// holds it; not where it was not measured.
std::string recommended_quadrature(const Input& input, const Scene& scene) {
  if (input.describing() || !is_conforming(scene)) return "mixed";
  if (scene.facts.get<Discretization>().degree != 2 || !input.has("body_force")) return "mixed";
  for (const char* key : {"openings", "surface_tension"}) {
    if (input.has(key)) return "mixed";
  }
  std::vector<std::string> motions;
  for (std::size_t b = 0; b < input.elements("bodies").value_or(0); ++b)
    motions.push_back("bodies/" + std::to_string(b) + "/motion");
  if (!motions.empty() && (input.has("fluids") || any_has(input, motions, {"free"}))) return "mixed";
  std::vector<std::string> laws{"fluid/rheology"};
  if (input.has("fluids")) {
    laws = input.names("fluids");
    for (std::string& name : laws) name = "fluids/" + name + "/rheology";
  }
  return any_has(input, laws, {"bingham", "herschel_bulkley", "mu_i"}) ? "mixed" : "exact";
}

}  // namespace

void add_quadrature(SystemRegistry& registry) {
  registry.add<FindFilledNodes>("find_filled_nodes");
  registry.add<GatherMoments>("moments");
  registry.add<FindLiquidSurface>("find_liquid_surface", OnRanks::adds_up);
  registry.add<FindUnseenLiquid>("find_unseen_liquid", OnRanks::adds_up);
  registry.add<FindUnseenForce>("find_unseen_force", OnRanks::adds_up);
  registry.add<FindExactVolume>("find_exact_volume", OnRanks::adds_up);
  registry.add<FindPressureAcceleration>("find_pressure_acceleration", OnRanks::adds_up);
  registry.add<FindExactShare>("find_exact_share", OnRanks::adds_up);
  registry.add<AddExactPressure>("add_exact_pressure", OnRanks::own);
  registry.add(Quadrature{{"mixed", "exact inside the liquid, by particles at its surface", read_mixed}});
  registry.add(Quadrature{
      {"exact", "mixed, and at the surface of a liquid nearly at rest pressure meets exact integrals", read_exact}});
  registry.add(Quadrature{{"particles", "by particles alone", read_particles}});
  const DefaultScheme fallback{
      recommended_quadrature,
      "\"exact\" under a body_force, with degree 2, without yield stress, openings and surface_tension; "
      "with bodies where none of these is free, without fluids"};
  registry.add(choice<Quadrature>("quadrature", "integrals of the balances", fallback));
}

}  // namespace minamo
