#include "components/instant.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/scene.hpp"
#include "systems/scene/scene_checks.hpp"
#include "systems/time/ode.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

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

/// Variables with a bad name are left out, so that expressions know the others. Those past the most are noted.
void add_variable(Scene& scene, ode::Equations& equations, const std::string& name, double start,
                  const Expression& rate) {
  scene.scope.variables.push_back(name);
  equations.name.push_back(name);
  equations.rate.push_back(rate);
  if (scene.start.ode_count < most_ode_variables) scene.start.ode[scene.start.ode_count++] = start;
}

/// \pre there are variables, not too many.
Seed seed_ode(ode::Equations equations) {
  return [equations](const Scene& scene, World& world, SeedProblems& problems) {
    world.resource<ode::Equations>() = equations;
    static_cast<Instant&>(world.resource<ode::Values>()) = scene.start;
    std::vector<double> arguments{0};
    arguments.insert(arguments.end(), scene.start.ode.begin(),
                     scene.start.ode.begin() + static_cast<std::ptrdiff_t>(scene.start.ode_count));
    for (std::size_t k = 0; k < equations.name.size(); ++k) {
      const double rate = equations.rate[k](arguments);
      if (std::isfinite(rate)) continue;
      problems.note(fmt::format("/ode/{}/rate", equations.name[k]), "not finite", "a finite rate at the start",
                    fmt::format("{} at t = 0", rate));
    }
  };
}

Contribution read_ode(Input& input, Scene& scene) {
  const std::vector<std::string> names = ode_names(input, scene.constants);
  ExpressionScope of_rate{{"t"}, scene.constants};
  of_rate.variables.insert(of_rate.variables.end(), names.begin(), names.end());
  ode::Equations equations;
  input.named_objects(
      "ode", "variables integrated along with the flow, which expressions may use by name",
      [&](Input& in, const std::string& name) {
        const Expression start = in.expression("start", {{}, scene.constants}, {.unit = "", .doc = "value at t = 0"});
        const Expression rate = in.expression("rate", of_rate, {.unit = "", .doc = "change per second"});
        if (std::find(names.begin(), names.end(), name) == names.end()) return;
        add_variable(scene, equations, name, start({}), rate);
      });
  if (equations.name.empty()) return {};
  return [equations](const Scene&, Recipe& recipe) { recipe.seed(seed_ode(equations)); };
}

}  // namespace

void add_ode(SystemRegistry& registry) {
  registry.add<IntegrateOde>("integrate_ode", OnRanks::alike_on_all);
  registry.add<HoldOde>("hold_ode", OnRanks::alike_on_all);
  registry.add(Part{"ode", "variables that are integrated along with the flow", read_ode});
}

}  // namespace minamo
