#pragma once
/// \file
/// The exact solution of a scene, to measure errors against.

#include "engine/input/expression.hpp"
#include "engine/storage/component.hpp"

#include <array>
#include <limits>
#include <vector>

namespace minamo::exact {

/// Particles are compared in this many parts side by side. Each has its own copy of the expressions, which keep their
/// variables inside.
inline constexpr std::size_t parts = 16;

/// v_e. [m/s]
struct Velocity {
  std::array<std::vector<Expression>, parts> of_part;      ///< per direction, as scene_scope() says
  double until = std::numeric_limits<double>::infinity();  ///< known up to this time [s]
  static constexpr ComponentInfo info{"exact.velocity", "v_e", "m/s", Lifetime::constant};
};

/// p_e. [Pa]
struct Pressure {
  std::vector<Expression> of_part;
  bool is_free = false;                                    ///< known up to a constant only
  double until = std::numeric_limits<double>::infinity();  ///< known up to this time [s]
  static constexpr ComponentInfo info{"exact.pressure", "p_e", "Pa", Lifetime::constant};
};

}  // namespace minamo::exact
