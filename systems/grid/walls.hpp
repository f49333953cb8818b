#pragma once
/// \file
/// Walls: the sides of the grid box, slip or no-slip. Those with a slip length hold as slip walls do; their friction is
/// in systems/viscosity/friction_matrices.hpp.

#include "components/node.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E8)  v_I = w_I in the held directions: v_I . n = 0 at slip walls at rest, v_I = 0 at no-slip walls at rest.
template <int Dim>
struct ApplyWallCondition {
  static constexpr Doc doc = "(E8) wall conditions on v_I^n";
  void operator()(Read<node::Constraint> constraint, Optional<Read<node::ConstraintFrame<Dim>>> frame,
                  Optional<Read<node::ConstraintVelocity<Dim>>> w_i, Update<node::Velocity<Dim>> v_i) const;
};

/// (E8) for the acceleration, which is zero there: walls move steadily.
template <int Dim>
struct ApplyWallConditionAcceleration {
  static constexpr Doc doc = "(E8) wall conditions on a_I^n";
  void operator()(Read<node::Constraint> constraint, Optional<Read<node::ConstraintFrame<Dim>>> frame,
                  Update<node::Acceleration<Dim>> a_i) const;
};

}  // namespace minamo
