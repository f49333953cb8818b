#pragma once
/// \file
/// Velocities and moments of rigid bodies.

#include "components/types.hpp"

#include <Eigen/Geometry>

namespace minamo {

/// The velocity of a point at a distance r from the one that a body turns about: V + omega x r.
inline Vec<2> rigid_velocity(const Vec<2>& velocity, const Vec<1>& spin, const Vec<2>& r) {
  return {velocity[0] - spin[0] * r[1], velocity[1] + spin[0] * r[0]};
}
inline Vec<3> rigid_velocity(const Vec<3>& velocity, const Vec<3>& spin, const Vec<3>& r) {
  return velocity + spin.cross(r);
}

/// r x f.
inline Vec<1> moment_of(const Vec<2>& r, const Vec<2>& f) { return Vec<1>(r[0] * f[1] - r[1] * f[0]); }
inline Vec<3> moment_of(const Vec<3>& r, const Vec<3>& f) { return r.cross(f); }

/// How many numbers a rigid motion has: its velocity, then its angular velocity.
template <int Dim>
inline constexpr int rigid_motions = Dim + rotations<Dim>;

/// The velocity of a wall and its angular velocity, or the force on it and the torque, about the point that it turns
/// about. [m/s, 1/s or N, N m]
template <int Dim>
using RigidVector = Eigen::Matrix<double, rigid_motions<Dim>, 1, Eigen::DontAlign>;

template <int Dim>
RigidVector<Dim> rigid_vector(const Vec<Dim>& along, const Vec<rotations<Dim>>& around) {
  RigidVector<Dim> both;
  for (Eigen::Index d = 0; d < Dim; ++d) both[d] = along[d];
  for (Eigen::Index d = 0; d < rotations<Dim>; ++d) both[Dim + d] = around[d];
  return both;
}

/// What the motions of a wall move a point at r along an axis: its velocity there is the product with the motion.
template <int Dim>
RigidVector<Dim> rigid_lever(const Vec<Dim>& r, Eigen::Index axis) {
  const Vec<Dim> e = Vec<Dim>::Unit(axis);
  return rigid_vector<Dim>(e, moment_of(r, e));
}

}  // namespace minamo
