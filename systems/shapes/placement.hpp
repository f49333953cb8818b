#pragma once
/// \file
/// Where a rigid body is: a motion without deformation from the place in which its shape is given.

#include "systems/shapes/rotation.hpp"
#include "systems/shapes/shape.hpp"

namespace minamo {

/// Takes a point X of the shape as given to x = position + rotation (X - pivot).
template <int Dim>
struct Placement {
  Vec<Dim> pivot = Vec<Dim>::Zero();         ///< point of the shape as given, its centre of mass for example [m]
  Vec<Dim> position = Vec<Dim>::Zero();      ///< where that point is now [m]
  Mat<Dim> rotation = Mat<Dim>::Identity();  ///< orthogonal, with determinant 1 [1]

  Vec<Dim> to_world(const Vec<Dim>& X) const { return position + rotation * (X - pivot); }
  Vec<Dim> to_body(const Vec<Dim>& x) const { return pivot + rotation.transpose() * (x - position); }
  Vec<Dim> direction_to_world(const Vec<Dim>& N) const { return rotation * N; }
  Vec<Dim> direction_to_body(const Vec<Dim>& n) const { return rotation.transpose() * n; }

  double distance(const Shape<Dim>& shape, const Vec<Dim>& x) const { return shape.distance(to_body(x)); }
  Vec<Dim> gradient(const Shape<Dim>& shape, const Vec<Dim>& x) const {
    return direction_to_world(shape.gradient(to_body(x)));
  }

  /// Of the moved box: not the tightest around the moved shape.
  Bounds<Dim> bounds(const Bounds<Dim>& of_shape) const {
    if (!of_shape.finite()) return {};
    const Vec<Dim> middle = to_world((of_shape.low + of_shape.high) / 2);
    const Vec<Dim> half = rotation.cwiseAbs() * ((of_shape.high - of_shape.low) / 2);
    return {middle - half, middle + half};
  }

  Facet<Dim> to_world(const Facet<Dim>& facet) const {
    const Vec<Dim> normal = direction_to_world(facet.normal);
    return {normal, facet.offset - facet.normal.dot(pivot) + normal.dot(position), facet.face};
  }
};

}  // namespace minamo
