#pragma once
/// \file
/// What a signed distance must be, found out from which points a shape contains. A source of its own, since tests with
/// the sanitizers are compiled without optimization and these look at millions of points.

#include "support/extremes.hpp"

#include "systems/shapes/shape.hpp"

#include <random>
#include <vector>

namespace minamo::shape_checks {

template <int Dim>
Vec<Dim> random_point(const Bounds<Dim>& box, std::mt19937_64& random);

/// Around a box, by a share of its diagonal.
template <int Dim>
Bounds<Dim> around(const Bounds<Dim>& box, double share = 0.3);

/// Points of the surface, each between a random point inside and one outside.
template <int Dim>
std::vector<Vec<Dim>> surface_points(const Shape<Dim>& shape, const Bounds<Dim>& where, std::size_t count);

/// The distance is that of some surface point, where the gradient points from or to, and none is nearer.
template <int Dim>
void check_euclidean(const Shape<Dim>& shape, const Bounds<Dim>& where, double rounding = 1e-9);

/// The share of a box that a shape fills, by counting the middles of n^d parts.
template <int Dim>
double measure(const Shape<Dim>& shape, const Bounds<Dim>& box, int n);

/// No surface point lies outside the bounds, and some near each of their sides.
template <int Dim>
void check_bounds(const Shape<Dim>& shape, double share);

/// A point lies in a part just if the shape contains it.
template <int Dim>
void check_parts(const Shape<Dim>& shape, const Bounds<Dim>& where);

}  // namespace minamo::shape_checks
