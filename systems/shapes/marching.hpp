#pragma once
/// \file
/// Where a function is zero, found by its signs at the nodes of a lattice: lines by marching squares, triangles by
/// marching tetrahedra (A. Doi, A. Koide, IEICE Trans. E74 (1991) 214), which close around what is negative.

#include "systems/shapes/outline.hpp"

#include <functional>

namespace minamo {

/// Nodes where a function is sampled, x fastest.
template <int Dim>
struct SampleNodes {
  Vec<Dim> low = Vec<Dim>::Zero();
  double spacing = 0;  ///< [m]
  Index<Dim> count{};  ///< per direction, at least 2

  /// Around a box, so that the outermost nodes lie outside of it and none on its sides.
  static SampleNodes around(const Bounds<Dim>& box, double spacing);
  std::size_t size() const;
  Vec<Dim> at(std::size_t row) const;
};

/// A signed distance, negative inside, and its gradient.
template <int Dim>
struct SampledShape {
  std::function<double(const Vec<Dim>&)> distance;
  std::function<Vec<Dim>(const Vec<Dim>&)> gradient;
  /// Whether a node is inside, where that is known without the distance; may be empty.
  std::function<bool(std::size_t row)> inside = {};
  /// How far the surface is from a node inside, on the way to one outside, in shares of it, where that is known without
  /// the distance; may be empty.
  std::function<double(std::size_t in, std::size_t out)> share = {};
};

/// Corners, where the tangents of two neighbouring points meet, are points, too; points on a straight line are left
/// out. \pre the function is positive at the outermost nodes
Outline<2> march_squares(const SampledShape<2>& shape, const SampleNodes<2>& nodes);

/// \pre the function is positive at the outermost nodes
Outline<3> march_tetrahedra(const SampledShape<3>& shape, const SampleNodes<3>& nodes);

}  // namespace minamo
