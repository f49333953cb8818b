#include "components/fluids.hpp"
#include "systems/equal_order/material.hpp"
#include "systems/equal_order/right_hand_side.hpp"
#include "systems/scene/parts.hpp"
#include "systems/viscosity/friction_choice.hpp"
#include "systems/viscosity/friction_matrices.hpp"
#include "systems/viscosity/law.hpp"
#include "systems/viscosity/mixture.hpp"
#include "systems/viscosity/read_rheology.hpp"
#include "systems/viscosity/shear_rate.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>

namespace minamo {

namespace {

/// The matrices of friction, when there are the splines.
template <int Dim>
void seed_friction(const Scene&, World& world, SeedProblems&) {
  world.resource<FrictionMatrices<Dim>>() = {world.resource<Grid<Dim>>(), world.resource<Splines<Dim>>(),
                                             world.resource<Walls<Dim>>()};
}

/// The system that gives cells their viscosity.
std::string cell_viscosity_of(const Scene& scene) {
  if (scene.facts.find<Fluids>()) return "find_cell_viscosity_of_fluids";
  return scene.facts.find<Rheology>() ? "find_cell_viscosity_by_particles" : "find_cell_viscosity";
}

void add_friction(const Scene& scene, Recipe& recipe) {
  if (friction_of(scene) == Friction::none) return;
  recipe.fill("<cell_viscosity>", std::vector{cell_viscosity_of(scene)});
  // Solves again with the viscosity of the velocities that the solve before has given.
  if (const auto* rheology = scene.facts.find<Rheology>()) {
    recipe.fill("<find_viscosity>", [iterations = rheology->iterations](std::vector<System> body) {
      return std::vector{make_loop<ViscosityLoop>("find_viscosity", std::move(body), iterations)};
    });
  }
  recipe.seed(scene.dimension == 2 ? Seed(seed_friction<2>) : Seed(seed_friction<3>));
}

/// What a scene says of a liquid.
struct Liquid {
  Fluid fluid;
  std::optional<Rheology> rheology;

  rheology::Law law() const {
    if (rheology) return rheology->laws.front();
    return rheology::PowerLaw{.consistency = fluid.viscosity, .index = 1, .least = 0, .most = fluid.viscosity};
  }
};

Liquid read_liquid(Input& in) {
  Liquid liquid;
  liquid.fluid.density = in.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
  in.one_of("viscosity",
            {{"viscosity",
              [&](Input& of) {
                liquid.fluid.viscosity =
                    of.number("viscosity", {.unit = "Pa s", .doc = "dynamic viscosity; 0 is inviscid", .at_least = 0});
              }},
             {"rheology", [&](Input& of) {
                of.object("rheology", "a viscosity that depends on the shear rate", Input::Presence::required,
                          [&](Input& rheology) { liquid.rheology = read_rheology(rheology); });
              }}});
  // Without pressure, and at rest.
  if (liquid.rheology && !in.describing() && !liquid.rheology->laws.empty())
    liquid.fluid.viscosity = viscosity_at(liquid.law(), 0);
  return liquid;
}

void read_one(Input& input, Scene& scene) {
  Liquid liquid;
  input.object("fluid", "the liquid", Input::Presence::required, [&](Input& in) { liquid = read_liquid(in); });
  if (liquid.rheology) scene.facts.set(*liquid.rheology);
  scene.facts.set(liquid.fluid);
}

/// The liquids of a scene together: the density of the heaviest, the viscosity of the thickest, a law for each if one
/// has one.
void read_several(Input& input, Scene& scene) {
  std::vector<Liquid> liquids;
  Fluids fluids;
  input.named_objects("fluids", "several liquids, by the names that particles have",
                      [&](Input& in, const std::string& name) {
                        liquids.push_back(read_liquid(in));
                        fluids.names.push_back(name);
                        fluids.of.push_back(liquids.back().fluid);
                      });
  if (input.describing()) return;
  if (liquids.empty() || liquids.size() > most_fluids)
    input.problem("fluids", "number of liquids", fmt::format("1 to {} of them", most_fluids),
                  fmt::format("{}", liquids.size()));
  fluids.of.resize(std::min(fluids.of.size(), most_fluids));
  Fluid together;
  Rheology rheology;
  bool has_law = false;
  for (const Liquid& liquid : liquids) {
    together.density = std::max(together.density, liquid.fluid.density);
    together.viscosity = std::max(together.viscosity, liquid.fluid.viscosity);
    rheology.laws.push_back(liquid.law());
    if (!liquid.rheology) continue;
    has_law = true;
    rheology.iterations = std::max(rheology.iterations, liquid.rheology->iterations);
  }
  scene.facts.set(together);
  scene.facts.set(fluids);
  if (has_law) scene.facts.set(rheology);
}

Contribution read_fluid(Input& input, Scene& scene) {
  scene.facts.set(Fluid{});
  input.one_of("the liquid, or several", {{"fluid", [&](Input& in) { read_one(in, scene); }},
                                          {"fluids", [&](Input& in) { read_several(in, scene); }}});
  // With both: what particles name is no problem of its own.
  if (!input.describing() && input.has("fluids") && !scene.facts.find<Fluids>()) scene.facts.set(Fluids{});
  return [](const Scene& of, Recipe& recipe) {
    if (const auto* rheology = of.facts.find<Rheology>()) recipe.constant(*rheology);
    add_friction(of, recipe);
    recipe.constant(of.facts.get<Fluid>());
    if (const auto* fluids = of.facts.find<Fluids>()) recipe.constant(*fluids);
  };
}

}  // namespace

void add_fluid(SystemRegistry& registry) {
  registry.add<SetMaterial>("set_material");
  registry.add<FillRightHandSide>("right_hand_side");
  registry.add<ShearParticles>("shear_particles", OnRanks::own);
  registry.add<ShearParticlesAgain>("shear_particles_again", OnRanks::own);
  registry.add<FindCellViscosityByParticles>("find_cell_viscosity_by_particles", OnRanks::own);
  registry.add<KeepPressure>("keep_pressure", OnRanks::own);
  registry.add<KeepBalanceVelocity>("keep_balance_velocity", OnRanks::own);
  registry.add<CompareBalanceVelocity>("compare_balance_velocity", OnRanks::adds_up);
  registry.add<FindFaceDensity>("find_face_density", OnRanks::adds_up);
  registry.add<FindCellViscosityOfFluids>("find_cell_viscosity_of_fluids", OnRanks::own);
  registry.add(Part{"fluid", "density and viscosity of the liquid", read_fluid});
}

}  // namespace minamo
