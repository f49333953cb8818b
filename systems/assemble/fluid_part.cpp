#include "components/fluid.hpp"
#include "systems/assemble/material.hpp"
#include "systems/assemble/right_hand_side.hpp"
#include "systems/conforming/friction_choice.hpp"
#include "systems/conforming/friction_matrices.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"

namespace minamo {

namespace {

/// The matrices of friction, when there are the splines.
template <int Dim>
void seed_friction(const Scene&, World& world, SeedProblems&) {
  world.resource<FrictionMatrices<Dim>>() = {world.resource<Grid<Dim>>(), world.resource<Splines<Dim>>(),
                                             world.resource<Walls<Dim>>()};
}

void add_friction(const Scene& scene, Recipe& recipe) {
  const Friction friction = friction_of(scene);
  if (friction == Friction::none) return;
  recipe.add("material", "find_cell_viscosity");
  if (friction == Friction::at_start) recipe.add("assemble", "rub_faces");
  recipe.seed(scene.dimension == 2 ? Seed(seed_friction<2>) : Seed(seed_friction<3>));
}

Contribution read_fluid(Input& input, Scene& scene) {
  Fluid fluid;
  input.object("fluid", "the liquid", Input::Presence::required, [&](Input& in) {
    fluid.density = in.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
    fluid.viscosity =
        in.number("viscosity", {.unit = "Pa s", .doc = "dynamic viscosity; 0 is inviscid", .at_least = 0});
  });
  scene.facts.set(fluid);
  return [fluid](const Scene& of, Recipe& recipe) {
    add_systems(of, recipe, "p2g", {{}, {"p2g_multipliers"}});
    add_systems(of, recipe, "material", {{"set_material"}, {"find_fill"}});
    add_systems(of, recipe, "assemble", {{}, {"assemble_multipliers"}});
    add_systems(of, recipe, "right_hand_side", {{"right_hand_side"}, {"face_source"}});
    add_friction(of, recipe);
    recipe.constant(fluid);
  };
}

}  // namespace

void add_fluid(SystemRegistry& registry) {
  registry.add<SetMaterial>("set_material");
  registry.add<FillRightHandSide>("right_hand_side");
  registry.add(Part{"fluid", "density and viscosity of the liquid", read_fluid});
}

}  // namespace minamo
