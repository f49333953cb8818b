#pragma once
/// \file
/// The quadratic B-spline of knots 1 apart, around zero.

#include <cmath>

namespace minamo {

/// Where it ends on both sides.
inline constexpr double quadratic_spline_reach = 1.5;

inline double quadratic_spline(double t) {
  const double s = std::abs(t);
  const double rest = quadratic_spline_reach - s;
  if (s < 0.5) return 0.75 - s * s;
  return rest > 0 ? 0.5 * rest * rest : 0;
}

/// Its integral up to t: what of it lies on one side of a plane.
inline double quadratic_spline_below(double t) {
  const double s = std::abs(t);
  const double rest = quadratic_spline_reach - s;
  double beyond = 0;
  if (s < 0.5) {
    beyond = 0.5 - s * (0.75 - s * s / 3);
  } else if (rest > 0) {
    beyond = rest * rest * rest / 6;
  }
  return t < 0 ? beyond : 1 - beyond;
}

}  // namespace minamo
