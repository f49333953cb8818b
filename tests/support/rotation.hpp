#pragma once
/// \file
/// Rigid rotations and angular momentum by the right hand, written down a second time to compare with.

#include "components/measure.hpp"
#include "components/particle.hpp"
#include "support/kernels.hpp"
#include "systems/measure/conservation.hpp"

#include <array>

namespace minamo {

/// The two directions that a rotation about an axis turns into each other, the first into the second. The plane has one
/// axis, which stands on it.
template <int Dim>
std::array<int, 2> turned_by(int axis) {
  return Dim == 2 ? std::array{0, 1} : std::array{(axis + 1) % Dim, (axis + 2) % Dim};
}

/// A rotation about an axis through the origin, counter-clockwise to who looks against the axis if `rate` > 0.
template <int Dim>
struct RigidRotation {
  int axis = 0;
  double rate = 0;  ///< [1/s]

  Vec<Dim> operator()(const Vec<Dim>& x) const { return gradient() * x; }
  Mat<Dim> gradient() const {
    const auto [a, b] = turned_by<Dim>(axis);
    Mat<Dim> grad_v = Mat<Dim>::Zero();
    grad_v(b, a) = rate;
    grad_v(a, b) = -rate;
    return grad_v;
  }
};

/// x times v.
template <int Dim>
Vec<rotations<Dim>> moment(const Vec<Dim>& x, const Vec<Dim>& v) {
  Vec<rotations<Dim>> about;
  for (int axis = 0; axis < rotations<Dim>; ++axis) {
    const auto [a, b] = turned_by<Dim>(axis);
    about[axis] = x[a] * v[b] - x[b] * v[a];
  }
  return about;
}

/// Of the particles at their weights' places, affine part included (E30), about the origin.
template <int Dim>
Vec<rotations<Dim>> particle_angular_momentum(World& world) {
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto x_p = world.column<particle::Position<Dim>>();
  std::copy(y_p.begin(), y_p.end(), x_p.begin());
  kernels::run<MeasureMomentum<Dim>>(world);
  const auto m_p = world.column<particle::Mass>();
  double mass = 0;
  Vec<Dim> centre = Vec<Dim>::Zero();
  for (std::size_t p = 0; p < m_p.size(); ++p) {
    mass += m_p[p];
    centre += m_p[p] * x_p[p];
  }
  centre /= mass;
  const auto& momentum = world.resource<measure::Momentum<Dim>>();
  return momentum.angular + moment<Dim>(centre, momentum.linear);
}

}  // namespace minamo
