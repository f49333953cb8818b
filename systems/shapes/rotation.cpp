#include "systems/shapes/rotation.hpp"

namespace minamo {

Mat<3> rotation(double angle, const Vec<3>& axis) {
  const Vec<3> e = axis.stableNormalized();
  Mat<3> cross;
  cross << 0, -e[2], e[1], e[2], 0, -e[0], -e[1], e[0], 0;
  return Mat<3>::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * cross * cross;
}

}  // namespace minamo
