#pragma once
/// \file
/// Energy that the liquid gets from what has none in (E28).

#include "engine/storage/component.hpp"

#include <array>

namespace minamo {

/// Since the start; only in scenes where something gives it. Plain data.
struct EnergyGiven {
  /// What systems say that they have given: a system that changes velocities of particles, or adds to the balances
  /// otherwise than by a force per unit mass, adds here what that brings, over all ranks. [J]
  double value = 0;
  double by_forces = 0;                   ///< work of forces per unit mass that have no potential, (E128) [J]
  double weight = 0;                      ///< largest sum of |m b| so far [N]
  std::array<double, 3> uniform_force{};  ///< b of the last step, where it is the same everywhere [m/s^2]
  bool has_stepped = false;               ///< whether a step has set uniform_force
  static constexpr ComponentInfo info{"energy_given", "W", "J", Lifetime::state};
};

}  // namespace minamo
