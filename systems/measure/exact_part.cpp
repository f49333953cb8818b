#include "systems/measure/exact_part.hpp"

#include "components/exact.hpp"
#include "components/vector_text.hpp"
#include "systems/measure/error.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene.hpp"
#include "systems/scene/scene_checks.hpp"

#include <cmath>

namespace minamo {

namespace {

/// The first particle where an exact field is not finite.
template <int Dim>
void check(const std::string& pointer, const Expression& field, const Scene& scene, World& world,
           SeedProblems& problems) {
  Arguments arguments(scene.start);
  for (const Vec<Dim>& x : world.column<particle::Position<Dim>>()) {
    const double value = field(arguments.at<Dim>(x));
    if (std::isfinite(value)) continue;
    problems.note(pointer, "not finite", "a finite value at every particle",
                  fmt::format("{} at {}, t = 0", value, place_text<Dim>(x)));
    return;
  }
}

template <int Dim>
void seed(const ExactScene& exact, const Scene& scene, World& world, SeedProblems& problems) {
  if (!exact.velocity.empty()) {
    world.resource<exact::Velocity>().of_part.fill(exact.velocity);
    world.resource<exact::Velocity>().until = exact.until;
  }
  for (std::size_t d = 0; d < exact.velocity.size(); ++d) {
    check<Dim>(fmt::format("/exact/velocity/{}", d), exact.velocity[d], scene, world, problems);
  }
  if (!exact.pressure) return;
  world.resource<exact::Pressure>() = {std::vector(exact::parts, *exact.pressure), exact.pressure_is_free, exact.until};
  check<Dim>("/exact/pressure", *exact.pressure, scene, world, problems);
}

ExactScene read_fields(Input& in, const Scene& scene) {
  ExactScene exact;
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  exact.velocity = in.optional_expressions("velocity", dimension, scene.scope, {.unit = "m/s", .doc = "exact velocity"})
                       .value_or(exact.velocity);
  exact.pressure = in.optional_expression("pressure", scene.scope, {.unit = "Pa", .doc = "exact pressure"});
  exact.pressure_is_free =
      in.choice("pressure_mean", std::vector<std::string>{"fixed", "free"},
                "free: the pressure is known up to a constant only, as in a closed box that is full; its error is "
                "measured with the volume means of both pressures removed",
                "fixed") == "free";
  exact.until = in.optional_number("until", {.unit = "s", .doc = "time up to which it is known", .at_least = 0})
                    .value_or(exact.until);
  for (std::size_t d = 0; d < exact.velocity.size(); ++d) {
    check_coordinates(in, fmt::format("velocity/{}", d), exact.velocity[d], scene.dimension);
  }
  if (exact.pressure) check_coordinates(in, "pressure", *exact.pressure, scene.dimension);
  if (!in.has("velocity") && !in.has("pressure")) {
    in.problem("", "nothing to compare with", "velocity, pressure, or both");
  }
  return exact;
}

Contribution read_exact(Input& input, Scene& scene) {
  ExactScene exact;
  input.object("exact", "the exact solution, to measure errors", Input::Presence::only_if_present,
               [&](Input& in) { exact = read_fields(in, scene); });
  scene.facts.set(exact);
  return [exact](const Scene&, Recipe& recipe) {
    recipe.seed([exact](const Scene& of, World& world, SeedProblems& problems) {
      with_dimension(of.dimension, [&](auto dim) { seed<dim()>(exact, of, world, problems); });
    });
  };
}

}  // namespace

void add_exact(SystemRegistry& registry) {
  registry.add<MeasureErrorVelocity>("measure_error_velocity", OnRanks::adds_up);
  registry.add<MeasureErrorPressure>("measure_error_pressure", OnRanks::adds_up);
  registry.add(Part{"exact", "the exact solution, to measure errors", read_exact});
}

}  // namespace minamo
