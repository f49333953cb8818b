#pragma once
/// \file
/// Points all over the surface of a body, and which of them hang together.

#include "components/types.hpp"
#include "systems/shapes/outline.hpp"

namespace minamo {

/// Points of the surface of a shape from its outline; not of the box that an endless one is cut off at.
/// \param box      outside of it there are only the points that the outline has [m]
/// \param spacing  between neighbours at most, about [m]
template <int Dim>
std::vector<Vec<Dim>> samples_of(const Shape<Dim>& shape, const Outline<Dim>& outline, const Bounds<Dim>& box,
                                 double spacing);

/// Numbers of groups of points: of points within a distance of each other, and those within it of them, and so on.
template <int Dim>
std::vector<std::size_t> groups_of(const std::vector<Vec<Dim>>& points, double distance);

}  // namespace minamo
