#pragma once
/// \file
/// A solid bounded by triangles.

#include "systems/shapes/closed_surface.hpp"
#include "systems/shapes/shape.hpp"

namespace minamo::shapes {

class Mesh : public Shape<3> {
 public:
  explicit Mesh(ClosedSurface surface);
  ~Mesh() override;

  /// The Euclidean distance: to the nearest triangle, found in a tree of boxes, in time about the logarithm of their
  /// number.
  double distance(const Vec<3>& x) const override;
  Vec<3> gradient(const Vec<3>& x) const override;
  Bounds<3> bounds() const override;

  const ClosedSurface& surface() const { return surface_; }

 private:
  struct Tree;

  ClosedSurface surface_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace minamo::shapes
