#pragma once
/// \file
/// The liquid and what drives it.

#include "components/types.hpp"
#include "engine/input/expression.hpp"
#include "engine/storage/component.hpp"

#include <algorithm>
#include <vector>

namespace minamo {

/// The liquid, where there is one; of several see components/fluids.hpp.
struct Fluid {
  double density = 0;    ///< rho [kg/m^3]
  double viscosity = 0;  ///< dynamic viscosity mu [Pa s]
  static constexpr ComponentInfo info{"fluid", "rho, mu", "kg/m^3, Pa s", Lifetime::constant};
};

/// Body force per unit mass b, one expression in x, y, z, t per direction. [m/s^2]
struct BodyForce {
  std::vector<Expression> of_place_and_time;  ///< per direction

  /// Whether it is zero everywhere, always.
  bool is_zero() const {
    return std::all_of(of_place_and_time.begin(), of_place_and_time.end(),
                       [](const Expression& b) { return b.is_constant() && b({}) == 0; });
  }
  /// Those that are the same everywhere, always; zero for others. [m/s^2]
  std::vector<double> constant_components() const {
    std::vector<double> force;
    for (const Expression& b : of_place_and_time) force.push_back(b.is_constant() ? b({}) : 0);
    return force;
  }
  /// Whether it is the same everywhere in 3-D.
  bool is_uniform() const {
    return std::none_of(of_place_and_time.begin(), of_place_and_time.end(),
                        [](const Expression& b) { return b.uses("x") || b.uses("y") || b.uses("z"); });
  }
  static constexpr ComponentInfo info{"body_force", "b", "m/s^2", Lifetime::constant};
};

}  // namespace minamo
