#include "systems/viscosity/friction_choice.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

/// With three digits, and not more than the number itself: what the message asks for is accepted.
std::string rounded_down(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 2);
  return fmt::format("{:.3g}", std::floor(number / unit * (1 + 1e-12)) * unit);
}

}  // namespace

std::string least_friction_text(const Scene& scene) {
  const double step = step_from_rest(scene);
  const double largest = largest_friction_at_start * friction_area(scene) / step;
  const Fluid& fluid = scene.facts.get<Fluid>();
  const double density = fluid.viscosity / largest_diffusivity(scene);
  const bool is_by_slip = friction_area(scene) < scene.grid.spacing * scene.grid.spacing;
  return fmt::format("at most {} Pa s, 0.01 rho {}/dt with the step of {:.3g} s; or steps of at most {} s",
                     rounded_down(largest * density), is_by_slip ? "h b with the slip length b" : "h^2", step,
                     rounded_down(step * largest / largest_diffusivity(scene)));
}

}  // namespace minamo
