#include "systems/measure/probes_part.hpp"

#include "components/measure.hpp"
#include "systems/measure/probes.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

namespace {

template <int Dim>
measure::Probes<Dim> make_probes(const ProbeScenes& scene) {
  measure::Probes<Dim> probes;
  for (const ProbeScene& probe : scene) {
    typename measure::Probes<Dim>::Probe made;
    made.pressure = probe.name + "_pressure";
    for (std::size_t d = 0; d < Dim; ++d) {
      made.at[static_cast<Eigen::Index>(d)] = probe.at[d];
      made.velocity[d] = fmt::format("{}_velocity_{}", probe.name, "xyz"[d]);
    }
    probes.probes.push_back(std::move(made));
  }
  return probes;
}

Contribution read_probes(Input& input, Scene& scene) {
  ProbeScenes probes;
  input.list("probes", "points whose pressure and velocity go into the history", 0, [&](Input& in, std::size_t) {
    ProbeScene probe;
    probe.name = in.text("name", {.doc = "its columns are NAME_pressure, NAME_velocity_x, ..."});
    probe.at = in.numbers("at", static_cast<std::size_t>(scene.dimension), {.unit = "m", .doc = "place"});
    if (in.sound("name") && !in.describing()) check_column_name(in, probe.name, "probe", scene);
    if (in.sound("at")) check_probe(in, probe.at, scene.grid);
    probes.push_back(std::move(probe));
  });
  scene.facts.set(probes);
  if (probes.empty()) return {};
  return [probes](const Scene& of, Recipe& recipe) {
    with_dimension(of.dimension, [&](auto dim) { recipe.constant(make_probes<dim()>(probes)); });
  };
}

}  // namespace

void add_probes(SystemRegistry& registry) {
  registry.add<MeasureProbes>("measure_probes");
  registry.add<MeasureProbesAtStart>("measure_probes_at_start");
  registry.add(Part{"probes", "points whose pressure and velocity go into the history", read_probes});
}

}  // namespace minamo
