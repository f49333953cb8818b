#include "components/fluid.hpp"
#include "systems/assemble/material.hpp"
#include "systems/assemble/right_hand_side.hpp"
#include "systems/conforming/friction_choice.hpp"
#include "systems/conforming/friction_matrices.hpp"
#include "systems/parts.hpp"
#include "systems/rheology/law.hpp"
#include "systems/rheology/read_rheology.hpp"
#include "systems/rheology/viscosity.hpp"
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
  if (const auto* rheology = scene.facts.find<Rheology>()) {
    recipe.add("material", "shear_particles");
    recipe.add("material", "find_cell_viscosity_by_particles");
    if (depends_on_pressure(rheology->law)) {
      recipe.add("accept", "recover_pressure");
      recipe.add("accept", "keep_pressure");
    }
  } else {
    recipe.add("material", "find_cell_viscosity");
  }
  if (friction == Friction::at_start) recipe.add("assemble", "rub_faces");
  recipe.seed(scene.dimension == 2 ? Seed(seed_friction<2>) : Seed(seed_friction<3>));
}

/// Solves again with the viscosity of the velocities that the solve before has given.
RepeatsFriction repeat_friction(int iterations) {
  return {[iterations](Recipe& recipe, const std::vector<std::string>& solve) {
    std::vector<System> body{recipe.make("shear_particles_again"), recipe.make("find_cell_viscosity_by_particles")};
    for (const std::string& system : solve) body.push_back(recipe.make(system));
    body.push_back(recipe.make("compare_balance_velocity"));
    recipe.add("solve", "keep_balance_velocity");
    recipe.add("solve", make_loop<ViscosityLoop>("find_viscosity", std::move(body), iterations));
  }};
}

/// \return the viscosity at rest, without pressure
double read_flow(Input& input, Scene& scene) {
  const Rheology rheology = read_rheology(input);
  if (input.describing()) return 0;
  if (!is_conforming(scene)) {
    input.problem("", "not with equal_order", R"("discretization": {"scheme": "conforming"})", "equal_order");
  }
  scene.facts.set(rheology);
  if (rheology.iterations > 1) scene.facts.set(repeat_friction(rheology.iterations));
  return viscosity_at(rheology.law, 0);
}

Contribution read_fluid(Input& input, Scene& scene) {
  Fluid fluid;
  input.object("fluid", "the liquid", Input::Presence::required, [&](Input& in) {
    fluid.density = in.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
    in.one_of("viscosity",
              {{"viscosity",
                [&](Input& of) {
                  fluid.viscosity = of.number(
                      "viscosity", {.unit = "Pa s", .doc = "dynamic viscosity; 0 is inviscid", .at_least = 0});
                }},
               {"rheology", [&](Input& of) {
                  of.object("rheology", "a viscosity that depends on the shear rate", Input::Presence::required,
                            [&](Input& rheology) { fluid.viscosity = read_flow(rheology, scene); });
                }}});
  });
  scene.facts.set(fluid);
  return [fluid](const Scene& of, Recipe& recipe) {
    if (const auto* rheology = of.facts.find<Rheology>()) recipe.constant(*rheology);
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
  registry.add<ShearParticles>("shear_particles");
  registry.add<ShearParticlesAgain>("shear_particles_again");
  registry.add<FindCellViscosityByParticles>("find_cell_viscosity_by_particles");
  registry.add<KeepPressure>("keep_pressure");
  registry.add<KeepBalanceVelocity>("keep_balance_velocity");
  registry.add<CompareBalanceVelocity>("compare_balance_velocity");
  registry.add(Part{"fluid", "density and viscosity of the liquid", read_fluid});
}

}  // namespace minamo
