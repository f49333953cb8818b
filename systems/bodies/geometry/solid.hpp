#pragma once
/// \file
/// What the shape of a rigid body says of it: volume, centre of mass, moments, and points of its surface.

#include "systems/shapes/shape.hpp"

namespace minamo {

/// Of a body with density 1.
template <int Dim>
struct Solid {
  double volume = 0;                                          ///< [m^3; m^2 in 2-D]
  Vec<Dim> centre = Vec<Dim>::Zero();                         ///< of mass [m]
  Mat<rotations<Dim>> inertia = Mat<rotations<Dim>>::Zero();  ///< about the centre [m^5; m^4 in 2-D]
};

/// By samples in the bounds of the shape, 400 per direction in 2-D and 100 in 3-D; a sample that the surface
/// crosses counts in part. A disc and a ball: to 1e-5 and 1e-4.
/// \pre the bounds are finite
template <int Dim>
Solid<Dim> solid_of(const Shape<Dim>& shape);

/// Points of the surface no more than about `spacing` apart, with the corners of a box along the axes.
/// \param spacing  [m]
/// \pre the bounds are finite
template <int Dim>
std::vector<Vec<Dim>> surface_points(const Shape<Dim>& shape, double spacing);

}  // namespace minamo
