#include "systems/setup/scene_measure.hpp"

#include "components/instant.hpp"
#include "systems/setup/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

/// The names that expressions can use, of those in the document; problems with the others are noted.
std::vector<std::string> ode_names(Input& input, const std::map<std::string, double>& constants) {
  std::vector<std::string> names;
  for (const std::string& name : input.names("ode")) {
    const std::string key = fmt::format("ode/{}", pointer_token(name));
    check_ode_name(input, key, name, scene_scope(constants));
    if (input.sound(key)) names.push_back(name);
  }
  if (names.size() > most_ode_variables) {
    input.problem("ode", "too many variables", fmt::format("at most {}", most_ode_variables),
                  std::to_string(names.size()));
  }
  return names;
}

/// Whether a history can have columns that begin with the name.
bool can_name_columns(const std::string& name) {
  return !name.empty() && name != "error" && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

void check_probe_name(Input& input, const std::string& name, const std::vector<ProbeScene>& earlier) {
  const bool is_twin =
      std::any_of(earlier.begin(), earlier.end(), [&](const auto& other) { return other.name == name; });
  if (is_twin) {
    input.problem("name", "name is taken by an earlier probe", "a name for each probe", shown(Json(name)));
  } else if (!can_name_columns(name)) {
    input.problem("name", "cannot name columns of the history", "letters, digits and _, and not \"error\"",
                  shown(Json(name)));
  }
}

}  // namespace

std::vector<OdeScene> read_ode(Input& input, const std::map<std::string, double>& constants) {
  const std::vector<std::string> names = ode_names(input, constants);
  ExpressionScope of_rate{{"t"}, constants};
  of_rate.variables.insert(of_rate.variables.end(), names.begin(), names.end());
  std::vector<OdeScene> ode;
  input.named_objects(
      "ode", "variables integrated beside the flow, which expressions may use by name",
      [&](Input& in, const std::string& name) {
        const Expression start = in.expression("start", {{}, constants}, {.unit = "", .doc = "value at t = 0"});
        const Expression rate = in.expression("rate", of_rate, {.unit = "", .doc = "change per second"});
        if (std::find(names.begin(), names.end(), name) == names.end()) return;
        ode.push_back({name, start({}), rate});
      });
  return ode;
}

ExactScene read_exact(Input& input, const Scene& scene) {
  ExactScene exact;
  const auto scope = scene_scope(scene.constants, scene.ode);
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  input.object("exact", "the exact solution, to measure errors", Input::Presence::only_if_present, [&](Input& in) {
    exact.velocity = in.optional_expressions("velocity", dimension, scope, {.unit = "m/s", .doc = "exact velocity"})
                         .value_or(exact.velocity);
    exact.pressure = in.optional_expression("pressure", scope, {.unit = "Pa", .doc = "exact pressure"});
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
  });
  return exact;
}

std::vector<ProbeScene> read_probes(Input& input, const Scene& scene) {
  std::vector<ProbeScene> probes;
  input.list("probes", "points whose pressure and velocity go into the history", 0, [&](Input& in, std::size_t) {
    ProbeScene probe;
    probe.name = in.text("name", {.doc = "its columns are NAME_pressure, NAME_velocity_x, ..."});
    probe.at = in.numbers("at", static_cast<std::size_t>(scene.dimension), {.unit = "m", .doc = "place"});
    if (in.sound("name") && !in.describing()) check_probe_name(in, probe.name, probes);
    if (in.sound("at")) check_probe(in, probe.at, scene.grid);
    probes.push_back(std::move(probe));
  });
  return probes;
}

}  // namespace minamo
