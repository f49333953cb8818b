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

Contribution read_midpoint(Input&, Scene& scene) {
  scene.facts.set(IntegratorNeeds{.also_configured = "place_quadrature_step_ahead", .gradients_move = true});
  return {};
}

Contribution read_newmark(Input& input, Scene& scene) {
  // The weights lag behind by more than what moving gradients mend.
  scene.facts.set(IntegratorNeeds{.also_configured = "place_quadrature_step_before", .gradients_move = false});
  NewmarkParameters parameters;
  parameters.beta = input.number("beta", {.doc = "Newmark's beta", .fallback = 0.25, .at_most = 0.5, .above = 0});
  parameters.gamma = input.number("gamma", {.doc = "Newmark's gamma", .fallback = 0.5, .at_least = 0.5, .at_most = 1});
  scene.facts.set(parameters);
  return [parameters](const Scene&, Recipe& recipe) { recipe.constant(parameters); };
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
