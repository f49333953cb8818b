#pragma once
/// \file
/// The exact solution that a scene gives.

#include "engine/input/expression.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace minamo {

/// Empty where the scene says nothing of a field.
struct ExactScene {
  std::vector<Expression> velocity;                        ///< [m/s]
  std::optional<Expression> pressure;                      ///< [Pa]
  bool pressure_is_free = false;                           ///< known up to a constant only
  double until = std::numeric_limits<double>::infinity();  ///< known up to this time [s]
};

}  // namespace minamo
