#pragma once
/// \file
/// A solid bounded by triangles.

#include "systems/shapes/closed_surface.hpp"
#include "systems/shapes/nearest_triangle.hpp"
#include "systems/shapes/shape.hpp"

namespace minamo::shapes {

class Mesh : public Shape<3> {
 public:
  explicit Mesh(ClosedSurface surface);

  /// The Euclidean distance, to the nearest triangle.
  double distance(const Vec<3>& x) const override;
  Vec<3> gradient(const Vec<3>& x) const override;
  Bounds<3> bounds() const override;

  const ClosedSurface& surface() const { return surface_; }

 private:
  ClosedSurface surface_;
  NearestTriangle nearest_;
};

}  // namespace minamo::shapes
