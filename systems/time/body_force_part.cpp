#include "components/vector_text.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/time/body_force.hpp"

namespace minamo {

namespace {

/// The body force must be finite where the liquid starts.
template <int Dim>
void check(const BodyForce& force, const Scene& scene, World& world, SeedProblems& problems) {
  Arguments arguments(scene.start);
  for (const Vec<Dim>& x : world.column<particle::Position<Dim>>()) {
    const Vec<Dim> b = vector_at<Dim>(force.of_place_and_time, arguments.at<Dim>(x));
    if (b.allFinite()) continue;
    problems.note("/body_force", "not finite", "a finite force per unit mass [m/s^2]",
                  fmt::format("{} at {}, t = 0", vector_text<Dim>(b), place_text<Dim>(x)));
    return;
  }
}

Contribution read_body_force(Input& input, Scene& scene) {
  const BodyForce force{
      read_vector(input, "body_force", scene, {.unit = "m/s^2", .doc = "force per unit mass", .fallback = 0})};
  scene.facts.set(force);
  return [force](const Scene&, Recipe& recipe) {
    recipe.constant(force);
    recipe.seed([force](const Scene& of, World& world, SeedProblems& problems) {
      with_dimension(of.dimension, [&](auto dim) { check<dim()>(force, of, world, problems); });
    });
  };
}

}  // namespace

void add_body_force(SystemRegistry& registry) {
  registry.add<UniformBodyForce>("uniform_body_force");
  registry.add<SampleBodyForce>("sample_body_force", OnRanks::own);
  registry.add<P2GBodyForce>("p2g_body_force");
  registry.add<MoveBallisticNodes>("move_ballistic_nodes");
  registry.add(Part{"body_force", "force per unit mass, uniform or in space and time", read_body_force});
}

}  // namespace minamo
