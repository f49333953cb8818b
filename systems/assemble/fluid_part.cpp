#include "components/fluid.hpp"
#include "systems/parts.hpp"
#include "systems/setup/scene.hpp"
#include "systems/assemble/matrices.hpp"
#include "systems/assemble/right_hand_side.hpp"

namespace minamo {

namespace {

Contribution read_fluid(Input& input, Scene& scene) {
  Fluid fluid;
  input.object("fluid", "the liquid", Input::Presence::required, [&](Input& in) {
    fluid.density = in.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
    fluid.viscosity = in.number("viscosity", {.unit = "Pa s", .doc = "dynamic viscosity; 0 is inviscid", .at_least = 0});
  });
  scene.facts.set(fluid);
  return [fluid](const Scene&, Recipe& recipe) {
    recipe.add("assemble", "divergence_matrix");
    if (fluid.viscosity > 0) recipe.add("assemble", "viscosity_matrix");
    recipe.add("right_hand_side", "right_hand_side");
    recipe.constant(fluid);
  };
}

}  // namespace

void add_fluid(SystemRegistry& registry) {
  registry.add<AssembleDivergence>("divergence_matrix");
  registry.add<AssembleViscosity>("viscosity_matrix");
  registry.add<FillRightHandSide>("right_hand_side");
  registry.add(Part{"fluid", "density and viscosity of the liquid", read_fluid});
}

}  // namespace minamo
