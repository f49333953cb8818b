#pragma once
/// \file
/// Rotation matrices.

#include "components/types.hpp"

#include <cmath>

namespace minamo {

/// By an angle in 2-D, from x to y. [rad]
inline Mat<2> rotation(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Mat<2> R;
  R << c, -s, s, c;
  return R;
}

/// By an angle [rad] about an axis of any length but zero (Rodrigues 1840).
Mat<3> rotation(double angle, const Vec<3>& axis);

/// By a vector along the axis, as long as the angle. [rad]
inline Mat<2> rotation_by(const Vec<1>& turn) { return rotation(turn[0]); }
inline Mat<3> rotation_by(const Vec<3>& turn) {
  return turn.norm() == 0 ? Mat<3>::Identity() : rotation(turn.norm(), turn);
}

}  // namespace minamo
