#pragma once
/// \file
/// How friction of the conforming discretization enters the balances of a scene.

#include "components/fluids.hpp"
#include "components/rheology.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/step/time_plan.hpp"

#include <algorithm>
#include <string>

namespace minamo {

enum class Friction { none, at_start, in_balances };

/// Of the thickest liquid, weighed by the lightest where there are several. [m^2/s]
inline double largest_diffusivity(const Scene& scene) {
  const Fluid& fluid = scene.facts.get<Fluid>();
  double lightest = fluid.density;
  if (const auto* fluids = scene.facts.find<Fluids>()) {
    for (const Fluid& of : fluids->of) lightest = std::min(lightest, of.density);
  }
  return fluid.viscosity / lightest;
}

/// Up to nu dt/h^2 = 1e-2 friction at the start of the step is exact enough, and costs next to nothing. A wall with
/// slip length b is as stiff as nu dt/(b h).
inline constexpr double largest_friction_at_start = 1e-2;

/// h^2, or b h of the shortest slip length b where that is less. [m^2]
inline double friction_area(const Scene& scene) {
  const double h = scene.grid.spacing;
  const auto* walls = scene.facts.find<WallFriction>();
  return walls == nullptr ? h * h : h * h / std::max(1.0, h * walls->largest_per_length);
}

/// A viscosity that depends on the flow has no bound that is known before.
inline Friction friction_of(const Scene& scene) {
  if (!is_conforming(scene)) return Friction::none;
  if (scene.facts.find<Rheology>() != nullptr) return Friction::in_balances;
  if (scene.facts.get<Fluid>().viscosity == 0) return Friction::none;
  const double number = largest_diffusivity(scene) * step_from_rest(scene) / friction_area(scene);
  constexpr double rounding = 1e-9;  // says nothing of one that is as large
  return number <= (1 + rounding) * largest_friction_at_start ? Friction::at_start : Friction::in_balances;
}

/// For the message where friction in the balances is not possible: the largest viscosity, and the longest step.
std::string least_friction_text(const Scene& scene);

}  // namespace minamo
