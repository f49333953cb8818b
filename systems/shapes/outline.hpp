#pragma once
/// \file
/// The surface of a shape to be looked at: closed lines in 2-D, triangles in 3-D. Nothing is computed with it.

#include "systems/shapes/shape.hpp"

#include <array>
#include <cstdint>

namespace minamo {

/// Closed: in 2-D every point begins one segment and ends one, in 3-D every edge has two triangles.
template <int Dim>
struct Outline {
  std::vector<Vec<Dim>> point;  ///< [m]
  /// Points of a segment, with the shape to its left, or of a triangle, counterclockwise seen from outside. Segments
  /// follow one another around a loop, and loop follows loop.
  std::vector<std::array<std::uint32_t, static_cast<std::size_t>(Dim)>> element;
};

/// Exact for boxes, polygons and meshes. Of other shapes the distance is sampled in their bounds: points are on the
/// surface, edges in 3-D are cut off by less than a sample, and what is thinner than a sample may be missed. Shapes
/// without bounds are cut off at the box.
/// \param box      finite [m]
/// \param spacing  of the samples at most, but for shapes that are very large against it [m]
template <int Dim>
Outline<Dim> outline_of(const Shape<Dim>& shape, const Bounds<Dim>& box, double spacing);

/// What an outline takes as points and elements of 8 bytes per number, about. [byte]
template <int Dim>
double outline_bytes(const Shape<Dim>& shape, const Bounds<Dim>& box, double spacing);

}  // namespace minamo
