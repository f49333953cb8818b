#include "systems/surface_tension/capillary_step.hpp"

#include "components/fluid.hpp"
#include "components/surface_tension.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <numbers>

namespace minamo {

std::optional<double> capillary_step(const Scene& scene) {
  const auto* tension = scene.facts.find<SurfaceTension>();
  if (tension == nullptr || tension->coefficient == 0) return {};
  const double rho = scene.facts.get<Fluid>().density;
  return 0.5 * std::sqrt(rho * std::pow(scene.grid.spacing, 3) / (2 * std::numbers::pi * tension->coefficient));
}

std::vector<std::string> warnings_of_surface_tension(const Scene& scene) {
  const auto longest = capillary_step(scene);
  if (!longest || !scene.time.step || *scene.time.step <= *longest) return {};
  return {fmt::format("a step of {:.3g} s is longer than waves of surface tension allow, {:.3g} s", *scene.time.step,
                      *longest)};
}

}  // namespace minamo
