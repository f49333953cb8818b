#pragma once
/// \file
/// The points that integrals over the free surface are made of.

#include "components/surface_tension.hpp"
#include "systems/surface_tension/surface_cube.hpp"

#include <cmath>

namespace minamo {

/// Calls use(point, its area) for three points of an element: with fewer, constant curvature does not balance constant
/// pressure and currents double.
template <int Dim, class Use>
void for_each_point(const typename FreeSurface<Dim>::Element& element, const Use& use) {
  const double area = area_of<Dim>(element);
  if constexpr (Dim == 2) {
    // Gauss's points, of degree 5.
    const Vec<2> middle = 0.5 * (element[0].x + element[1].x);
    const Vec<2> step = std::sqrt(0.15) * (element[1].x - element[0].x);
    use(Vec<2>(middle - step), 5.0 / 18 * area);
    use(middle, 8.0 / 18 * area);
    use(Vec<2>(middle + step), 5.0 / 18 * area);
  } else {
    // Of degree 2.
    const Vec<3> sixth = (element[0].x + element[1].x + element[2].x) / 6;
    for (const auto& corner : element) use(Vec<3>(sixth + 0.5 * corner.x), area / 3);
  }
}

/// The same for all elements of a piece.
template <int Dim, class Use>
void for_each_point_of_piece(const typename FreeSurface<Dim>::Piece& piece, const Use& use) {
  for (const auto& element : piece.elements) for_each_point<Dim>(element, use);
}

}  // namespace minamo
