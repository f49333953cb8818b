#pragma once
/// \file
/// Walls: the sides of the grid box, slip or no-slip.

#include "components/node.hpp"
#include "engine/system.hpp"

namespace minamo {

/// (E8)  v_I . n = 0 at slip walls, v_I = 0 at no-slip walls.
template <int Dim>
struct HoldVelocityAtWalls {
  static constexpr std::string_view doc = "(E8) wall conditions on v_I^n";
  void operator()(Read<node::Fixed> fixed, Update<node::Velocity<Dim>> v_i) const;
};

/// (E8) for the acceleration.
template <int Dim>
struct HoldAccelerationAtWalls {
  static constexpr std::string_view doc = "(E8) wall conditions on a_I^n";
  void operator()(Read<node::Fixed> fixed, Update<node::Acceleration<Dim>> a_i) const;
};

/// Sets the components of a nodal vector that a wall holds to zero.
template <int Dim>
inline void hold(std::uint8_t fixed, Vec<Dim>& value) {
  for (int d = 0; d < Dim; ++d) {
    if (fixed >> d & 1) value[d] = 0;
  }
}

}  // namespace minamo
