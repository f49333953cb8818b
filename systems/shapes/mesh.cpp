#include "systems/shapes/mesh.hpp"

#include <cmath>
#include <utility>

namespace minamo::shapes {

namespace {

double sign(const FootOnTriangle& foot, const Vec<3>& x) { return foot.normal.dot(x - foot.point) < 0 ? -1 : 1; }

}  // namespace

Mesh::Mesh(ClosedSurface surface) : surface_(std::move(surface)), nearest_(surface_) {}

double Mesh::distance(const Vec<3>& x) const {
  const FootOnTriangle foot = nearest_(surface_, x);
  return sign(foot, x) * std::sqrt(foot.squared);
}

Vec<3> Mesh::gradient(const Vec<3>& x) const {
  const FootOnTriangle foot = nearest_(surface_, x);
  // The difference of two close points has no direction to speak of.
  const double size = std::max(x.cwiseAbs().maxCoeff(), foot.point.cwiseAbs().maxCoeff());
  if (foot.is_on_triangle || foot.squared < std::pow(1e-9 * size, 2)) return foot.normal;
  return sign(foot, x) * (x - foot.point).stableNormalized();
}

Bounds<3> Mesh::bounds() const {
  Bounds<3> bounds{surface_.corner[0], surface_.corner[0]};
  for (const Vec<3>& x : surface_.corner) bounds = {bounds.low.cwiseMin(x), bounds.high.cwiseMax(x)};
  return bounds;
}

}  // namespace minamo::shapes
