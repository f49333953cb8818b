#pragma once
/// \file
/// Drops of one particle, as they are looked at: a polygon of twelve corners, an icosahedron.

#include "systems/shapes/outline.hpp"

namespace minamo {

/// Of volume 1 around the origin.
template <int Dim>
Outline<Dim> unit_drop();

/// Adds a unit drop, moved and grown to a volume, to an outline.
/// \param x  its middle [m]
template <int Dim>
void add_drop(const Outline<Dim>& drop, const Vec<Dim>& x, double volume, Outline<Dim>& outline);

}  // namespace minamo
