#pragma once
/// \file
/// How a constraint acts on a nodal vector. No other place knows: kernels that hold what walls prescribe declare
/// node::Constraint, and of node::ConstraintFrame and node::ConstraintVelocity what they need, and call hold() or
/// hold_at_rest().

#include "components/node.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// The constraints of all nodes.
template <int Dim>
struct Constraints {
  std::span<const std::uint8_t> mask;
  std::span<const Mat<Dim>> frame = {};     ///< empty where all walls lie along the grid
  std::span<const Vec<Dim>> velocity = {};  ///< empty where all walls are at rest [m/s]
};

/// Gives a vector of node i, in the directions in which the node is held, the components of another one.
template <int Dim>
inline void replace_held(const Constraints<Dim>& constraints, std::size_t i, const Vec<Dim>& by, Vec<Dim>& value) {
  const std::uint8_t mask = constraints.mask[i];
  if (constraints.frame.empty()) {
    for (int d = 0; d < Dim; ++d) {
      if (mask >> d & 1) value[d] = by[d];
    }
  } else if (mask != 0) {
    const Vec<Dim> missing = constraints.frame[i] * (by - value);
    for (int d = 0; d < Dim; ++d) {
      if (mask >> d & 1) value += missing[d] * constraints.frame[i].row(d).transpose();
    }
  }
}

/// Takes the held directions out of a force, an acceleration or a change of velocity.
template <int Dim>
inline void hold_at_rest(const Constraints<Dim>& constraints, std::size_t i, Vec<Dim>& value) {
  replace_held<Dim>(constraints, i, Vec<Dim>::Zero(), value);
}

/// (E8)  Gives a velocity what the walls prescribe.
template <int Dim>
inline void hold(const Constraints<Dim>& constraints, std::size_t i, Vec<Dim>& velocity) {
  if (constraints.velocity.empty()) return hold_at_rest<Dim>(constraints, i, velocity);
  replace_held<Dim>(constraints, i, constraints.velocity[i], velocity);
}

/// (E8)  Gives a displacement u what makes the velocity c_v u + v^ the prescribed one.
/// \pre v^ is zero in the held directions of walls at rest, as is v^n.
template <int Dim>
inline void hold_displacement(const Constraints<Dim>& constraints, std::size_t i, double c_v, const Vec<Dim>& predicted,
                              Vec<Dim>& u) {
  if (constraints.velocity.empty()) return hold_at_rest<Dim>(constraints, i, u);
  replace_held<Dim>(constraints, i, (constraints.velocity[i] - predicted) / c_v, u);
}

}  // namespace minamo
