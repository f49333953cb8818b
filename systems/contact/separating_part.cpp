#include "systems/contact/loop.hpp"
#include "systems/contact/sides.hpp"
#include "systems/contact/surfaces.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/viscosity/friction_choice.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

/// What the balances of a step, or of a standing step, have in a slot already, in that order.
std::vector<System> placed_in(const Recipe& recipe, std::string_view slot, When when,
                              const std::vector<std::string>& names) {
  std::vector<System> systems;
  for (const Recipe::Placed& placed : recipe.placed()) {
    const bool is_named = std::find(names.begin(), names.end(), placed.system.name) != names.end();
    if (placed.slot == slot && (placed.when == When::always || placed.when == when) && is_named)
      systems.push_back(placed.system);
  }
  return systems;
}

System contact_loop(const Scene& scene, const Recipe& recipe, When when) {
  const auto& walls = scene.facts.get<RepeatsBalances>();
  std::vector<System> body;
  const auto add = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names) body.push_back(recipe.make(name));
  };
  if (walls.at_sides) add({"hold_contact_of_sides"});
  if (walls.at_bodies) add({"release_from_bodies"});
  add({"assemble_multipliers", "fill_contact_source"});
  if (walls.at_bodies) add({"detach_from_bodies"});
  for (const System& system :
       placed_in(recipe, "right_hand_side", when, {"damp_face_divergence", "face_volume_source"})) {
    body.push_back(system);
  }
  if (walls.at_sides) add({"limit_volume_source_at_sides"});
  const auto& solver = scene.facts.get<LinearSolver>();
  add(solver.solve_on_faces);
  if (const auto* completes = scene.facts.find<CompletesMultipliers>()) add(completes->systems);
  add(solver.project_on_faces);
  if (walls.at_sides) add({"compare_contact_of_sides"});
  if (walls.at_bodies) add({"compare_contact_of_bodies"});
  add({"end_contact_pass"});
  return make_loop<ContactLoop>("find_contact", std::move(body), most_contact_passes);
}

void add_contact(const Scene& scene, Recipe& recipe) {
  const auto& walls = scene.facts.get<RepeatsBalances>();
  if (walls.at_sides) {
    recipe.add("sort", "find_separating_faces");
    recipe.add("boundaries", "stop_old_velocity_at_sides");
    recipe.add("right_hand_side", "start_contact_of_sides");
  }
  if (walls.at_bodies) {
    recipe.add("sort", "find_separating_rows");
    recipe.add("p2g", "fill_empty_faces");
    recipe.add("right_hand_side", "start_contact_of_bodies");
  }
  for (const When when : {When::step, When::standing}) recipe.add("solve", contact_loop(scene, recipe, when), when);
  if (walls.at_sides) {
    recipe.add("solve", "keep_contact_of_sides");
    recipe.add("correct", "stop_new_velocity_at_sides", When::step);
  }
  recipe.add("measure", "measure_contact");
}

/// What solves the balances in another way does not know of contact.
void check_scene(const Scene& scene, SeedProblems& problems) {
  // What bodies have complained of already is the same problem.
  const auto note = [&](const std::string& pointer, const std::string& what, const std::string& expected,
                        const std::string& got) {
    const bool is_noted = std::any_of(problems.problems.begin(), problems.problems.end(),
                                      [&](const Problem& problem) { return problem.pointer == pointer; });
    if (!is_noted) problems.note(pointer, what, expected, got);
  };
  if (scene.facts.find<Rheology>() != nullptr) {
    note("/fluid/rheology", "not with separating walls", "a constant viscosity", "a rheology");
  } else if (friction_of(scene) == Friction::in_balances) {
    note("/fluid/viscosity", "too large for separating walls", least_friction_text(scene),
         fmt::format("{} Pa s", scene.facts.get<Fluid>().viscosity));
  }
  if (scene.schemes.at("integrator") == "newmark")
    note("/integrator/scheme", "not with separating walls", R"("midpoint")", R"("newmark")");
  if (scene.schemes.at("solver") == "umfpack")
    note("/solver/scheme", "not with separating walls", R"("block")", R"("umfpack")");
}

Contribution separating_walls(Input&, Scene&) {
  return [](const Scene& scene, Recipe& recipe) {
    if (scene.facts.find<RepeatsBalances>() == nullptr || !is_conforming(scene)) return;
    add_contact(scene, recipe);
    recipe.seed([](const Scene& of, World&, SeedProblems& problems) { check_scene(of, problems); });
  };
}

}  // namespace

void add_separating(SystemRegistry& registry) {
  registry.add<FindSeparatingFaces>("find_separating_faces");
  registry.add<StopOldVelocityAtSides>("stop_old_velocity_at_sides");
  registry.add<StartContactOfSides>("start_contact_of_sides");
  registry.add<HoldContactOfSides>("hold_contact_of_sides");
  registry.add<FindSeparatingRows>("find_separating_rows");
  registry.add<FillEmptyFaces>("fill_empty_faces");
  registry.add<DetachFromBodies>("detach_from_bodies");
  registry.add<StartContactOfBodies>("start_contact_of_bodies");
  registry.add<ReleaseFromBodies>("release_from_bodies");
  registry.add<CompareContactOfBodies>("compare_contact_of_bodies");
  registry.add<FillContactSource>("fill_contact_source");
  registry.add<LimitVolumeSourceAtSides>("limit_volume_source_at_sides");
  registry.add<CompareContactOfSides>("compare_contact_of_sides");
  registry.add<EndContactPass>("end_contact_pass");
  registry.add<KeepContactOfSides>("keep_contact_of_sides");
  registry.add<StopNewVelocityAtSides>("stop_new_velocity_at_sides");
  registry.add<MeasureContact>("measure_contact");
  registry.add(Part{"separating", "walls that the liquid may leave; no key, \"wall\" and \"walls\" say which",
                    separating_walls});
}

}  // namespace minamo
