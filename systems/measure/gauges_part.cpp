#include "systems/measure/gauges.hpp"
#include "systems/measure/own_column.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene_checks.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Against what is constant of the body force; without that along y.
std::vector<double> upwards(const Scene& scene) {
  std::vector<double> up(static_cast<std::size_t>(scene.dimension), 0);
  if (const auto* force = scene.facts.find<BodyForce>()) up = force->constant_components();
  for (double& component : up) component = -component;
  if (std::all_of(up.begin(), up.end(), [](double component) { return component == 0; })) up[1] = 1;
  return up;
}

template <int Dim>
void read_gauge(Input& input, Scene& scene, Gauges<Dim>& gauges) {
  typename Gauges<Dim>::Gauge gauge;
  gauge.name = input.text("name", {.doc = "of its column"});
  const auto at = input.numbers("at", Dim, {.unit = "m", .doc = "where heights begin"});
  const auto along = input.optional_numbers(
      "along", Dim,
      {.doc = "out of the liquid, of any length but zero; else against what is constant of body_force, or along y"});
  if (input.describing()) return;
  if (input.sound("name")) check_own_column(input, gauge.name, "gauge", scene);
  if (!input.sound("at") || !input.sound("along")) return;
  check_probe(input, at, scene.grid);
  gauge.at = vec_of<Dim>(at);
  gauge.along = vec_of<Dim>(along ? *along : upwards(scene));
  if (gauge.along.norm() == 0) {
    input.problem("along", "no direction", "a vector that is not zero");
    return;
  }
  gauge.along.stableNormalize();
  // sin(pi) is zero but for rounding, and would end the line at a wall.
  constexpr double rounding = 1e-12;
  gauge.along = (gauge.along.array().abs() < rounding).select(Vec<Dim>::Zero(), gauge.along);
  gauges.gauges.push_back(std::move(gauge));
}

template <int Dim>
Contribution read_gauges_in(Input& input, Scene& scene) {
  Gauges<Dim> gauges;
  input.list("gauges", "lines along which the height of the liquid's surface goes into the history", 0,
             [&](Input& in, std::size_t) { read_gauge<Dim>(in, scene, gauges); });
  if (gauges.gauges.empty()) return {};
  return [gauges](const Scene&, Recipe& recipe) { recipe.constant(gauges); };
}

Contribution read_gauges(Input& input, Scene& scene) {
  return with_dimension(scene.dimension, [&](auto dim) { return read_gauges_in<dim()>(input, scene); });
}

}  // namespace

void add_gauges(SystemRegistry& registry) {
  registry.add<MeasureGauges>("measure_gauges", OnRanks::adds_up);
  registry.add(
      Part{"gauges", "lines along which the height of the liquid's surface goes into the history", read_gauges});
}

}  // namespace minamo
