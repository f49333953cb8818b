#pragma once
/// \file
/// The point of a closed surface that is nearest to a point.

#include "systems/shapes/closed_surface.hpp"

#include <limits>
#include <memory>
#include <span>

namespace minamo::shapes {

/// Of a triangle the part that a point of it belongs to.
struct FootOnTriangle {
  Vec<3> point = Vec<3>::Zero();
  Vec<3> normal = Vec<3>::Zero();  ///< of the triangle, edge or corner that the point is on
  double squared = std::numeric_limits<double>::infinity();
  bool is_on_triangle = false;  ///< and not on an edge or a corner
};

/// Immutable. May be called from several threads at once.
class NearestTriangle {
 public:
  explicit NearestTriangle(const ClosedSurface& surface);
  ~NearestTriangle();

  /// In time about the logarithm of the number of triangles; near a surface of up to some thousands from a short list.
  /// \param surface  the same
  FootOnTriangle operator()(const ClosedSurface& surface, const Vec<3>& x) const;

 private:
  struct Tree;
  void list_triangles(const ClosedSurface& surface);
  /// The triangles of which one is the nearest to a point; none: unknown.
  std::span<const std::uint32_t> listed_at(const Vec<3>& x) const;

  std::unique_ptr<Tree> tree_;
  /// Voxels around the surface, x fastest.
  Vec<3> low_ = Vec<3>::Zero();  ///< [m]
  double side_ = 0;              ///< [m]
  Index<3> count_{};
  std::vector<std::uint32_t> start_;  ///< of the triangles of every voxel, and the end of the last
  std::vector<std::uint32_t> triangle_;
};

}  // namespace minamo::shapes
