#include "systems/equal_order/damp_divergence.hpp"
#include "systems/grid/walls.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/time/midpoint.hpp"
#include "systems/time/newmark.hpp"
#include "systems/time/quadrature_position.hpp"
#include "systems/time/turns.hpp"
#include "systems/transfer/scheme.hpp"

namespace minamo {

namespace {

const SystemsOf standing_prediction{{"predict_backward_euler"}, {"predict_faces_backward_euler"}};

Contribution read_midpoint(Input&, Scene& scene) {
  scene.facts.set(IntegratorNeeds{.configure_beside = "place_quadrature_step_ahead", .gradients_move = true});
  return [](const Scene& of, Recipe& recipe) {
    recipe.add("configure", "place_quadrature_at_middle", When::step);
    add_systems(of, recipe, "predict", {{"predict_midpoint"}, {"predict_faces_midpoint"}}, When::step);
    add_systems(of, recipe, "predict", standing_prediction, When::standing);
    add_systems(of, recipe, "right_hand_side", {{"damp_divergence"}, {"damp_face_divergence"}}, When::step);
    add_systems(of, recipe, "correct", {{"correct_midpoint"}, {"correct_faces_midpoint"}}, When::step);
  };
}

Contribution read_newmark(Input& input, Scene& scene) {
  // The weights lag behind by more than what moving gradients mend.
  scene.facts.set(IntegratorNeeds{.configure_beside = "place_quadrature_step_before", .gradients_move = false});
  NewmarkParameters parameters;
  parameters.beta = input.number("beta", {.doc = "Newmark's beta", .fallback = 0.25, .at_most = 0.5, .above = 0});
  parameters.gamma = input.number("gamma", {.doc = "Newmark's gamma", .fallback = 0.5, .at_least = 0.5, .at_most = 1});
  scene.facts.set(parameters);
  return [parameters](const Scene& of, Recipe& recipe) {
    const auto& acceleration = of.facts.get<AccelerationTransfer>();
    recipe.add("configure", "place_quadrature_at_start", When::step);
    for (const System& system : acceleration.p2g) recipe.add("p2g", system, When::step);
    add_systems(of, recipe, "boundaries", {{"apply_wall_condition_acceleration"}, {"hold_face_accelerations"}},
                When::step);
    add_systems(of, recipe, "predict", {{"predict_newmark"}, {"predict_faces_newmark"}}, When::step);
    add_systems(of, recipe, "predict", standing_prediction, When::standing);
    add_systems(of, recipe, "correct",
                {{"correct_newmark", "watch_turns"}, {"correct_faces_newmark", "watch_turns_of_faces"}}, When::step);
    for (const System& system : acceleration.g2p) recipe.add("g2p", system, When::step);
    std::vector<System> after{
        recipe.make(is_conforming(of) ? "correct_faces_backward_euler" : "correct_backward_euler")};
    after.insert(after.end(), acceleration.g2p.begin(), acceleration.g2p.end());
    recipe.add_standing_step("place_quadrature_step_before", after);
    recipe.constant(parameters);
  };
}

}  // namespace

void add_integrator(SystemRegistry& registry) {
  registry.add<PlaceQuadratureAtStart>("place_quadrature_at_start", OnRanks::own);
  registry.add<PlaceQuadratureAtMiddle>("place_quadrature_at_middle", OnRanks::own);
  registry.add<PlaceQuadratureStepBefore>("place_quadrature_step_before", OnRanks::own);
  registry.add<PlaceQuadratureStepAhead>("place_quadrature_step_ahead", OnRanks::own);
  registry.add<ApplyWallConditionAcceleration>("apply_wall_condition_acceleration");
  registry.add<PredictNewmark>("predict_newmark");
  registry.add<PredictMidpoint>("predict_midpoint");
  registry.add<PredictBackwardEuler>("predict_backward_euler");
  registry.add<DampDivergence>("damp_divergence");
  registry.add<CorrectNewmark>("correct_newmark");
  registry.add<WatchTurns>("watch_turns");
  registry.add<CorrectMidpoint>("correct_midpoint");
  registry.add<CorrectBackwardEuler>("correct_backward_euler");
  registry.add<CorrectBackwardEulerVelocity>("correct_backward_euler_velocity");
  registry.add(Integrator{{"midpoint", "balances in the middle of the step", read_midpoint}});
  registry.add(Integrator{{"newmark", "balances at the end of the step, particles carry accelerations", read_newmark}});
  registry.add(choice<Integrator>("integrator", "time integration", always("midpoint")));
}

}  // namespace minamo
