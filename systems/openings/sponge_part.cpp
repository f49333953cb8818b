#include "systems/openings/sponge.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene_checks.hpp"
#include "systems/transfer/scheme.hpp"

namespace minamo {

namespace {

Sponge read_one(Input& in, const Scene& scene) {
  const ExpressionScope scope = scene_scope(scene.constants);
  Sponge sponge;
  sponge.where = in.optional_expression("where", scope, {.doc = "where it is; without it, everywhere"});
  sponge.rate = in.expression(
      "rate", scope,
      {.unit = "1/s", .doc = "at which the liquid takes over the velocity; best rising slowly", .at_least = 0});
  sponge.toward = in.numbers("toward", static_cast<std::size_t>(scene.dimension),
                             {.unit = "m/s", .doc = "the velocity", .fallback = 0});
  if (in.describing()) return sponge;
  if (sponge.where) check_coordinates(in, "where", *sponge.where, scene.dimension);
  check_coordinates(in, "rate", sponge.rate, scene.dimension);
  return sponge;
}

Contribution read_sponges(Input& input, Scene& scene) {
  Sponges sponges;
  const bool is_there = input.elements("sponge").value_or(0) > 0;
  input.list("sponge", "regions that draw the liquid towards a velocity, so that waves end there", 0,
             [&](Input& in, std::size_t) { sponges.sponges.push_back(read_one(in, scene)); });
  if (!is_there || input.describing()) return {};
  return [sponges](const Scene&, Recipe& recipe) { recipe.constant(sponges); };
}

}  // namespace

void add_sponge(SystemRegistry& registry) {
  registry.add<SoakVelocity>("soak_velocity", OnRanks::own);
  registry.add<SoakGradient>("soak_gradient", OnRanks::own);
  registry.add(Part{"sponge", "regions that draw the liquid towards a velocity", read_sponges});
}

}  // namespace minamo
