#pragma once
/// \file
/// The points that integrals over the free surface are made of.

#include "components/surface_tension.hpp"
#include "systems/surface_tension/surface_cube.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace minamo {

/// Points of a triangle, of degree 2.
template <class Use>
void for_each_point_of_triangle(const std::array<Vec<3>, 3>& corner, double area, const Use& use) {
  const Vec<3> sixth = (corner[0] + corner[1] + corner[2]) / 6;
  for (const Vec<3>& x : corner) use(Vec<3>(sixth + 0.5 * x), area / 3);
}

/// Gauss's points of a flat quadrilateral, of degree 2.
template <class Use>
void for_each_point_of_quadrilateral(const std::array<Vec<3>, 4>& corner, const Use& use) {
  const double low = 0.5 - std::sqrt(1.0 / 12);
  for (const double a : {low, 1 - low}) {
    for (const double b : {low, 1 - low}) {
      const Vec<3> along_a = (1 - b) * (corner[1] - corner[0]) + b * (corner[2] - corner[3]);
      const Vec<3> along_b = (1 - a) * (corner[3] - corner[0]) + a * (corner[2] - corner[1]);
      const Vec<3> x = (1 - a) * ((1 - b) * corner[0] + b * corner[3]) + a * ((1 - b) * corner[1] + b * corner[2]);
      use(x, 0.25 * along_a.cross(along_b).norm());
    }
  }
}

/// Calls use(point, its area) for points of an element, three of a segment or a triangle: with fewer, constant
/// curvature does not balance constant pressure and currents double. None depends on where its corners begin.
template <int Dim, class Use>
void for_each_point(const typename FreeSurface<Dim>::Element& element, const Use& use) {
  if constexpr (Dim == 2) {
    const double area = area_of<Dim>(element);
    // Gauss's points, of degree 5.
    const Vec<2> middle = 0.5 * (element[0].x + element[1].x);
    const Vec<2> step = std::sqrt(0.15) * (element[1].x - element[0].x);
    use(Vec<2>(middle - step), 5.0 / 18 * area);
    use(middle, 8.0 / 18 * area);
    use(Vec<2>(middle + step), 5.0 / 18 * area);
  } else {
    if (element.size() == 3) {
      for_each_point_of_triangle({element[0].x, element[1].x, element[2].x}, area_of<Dim>(element), use);
      return;
    }
    if (element.size() == 4) {
      for_each_point_of_quadrilateral({element[0].x, element[1].x, element[2].x, element[3].x}, use);
      return;
    }
    Vec<3> middle = Vec<3>::Zero();
    for (const auto& corner : element) middle += corner.x / static_cast<double>(element.size());
    for (std::size_t k = 0; k < element.size(); ++k) {
      const Vec<3>& a = element[k].x;
      const Vec<3>& b = element[(k + 1) % element.size()].x;
      for_each_point_of_triangle({a, b, middle}, 0.5 * (a - middle).cross(b - middle).norm(), use);
    }
  }
}

/// The same for all elements of a piece, with the area that they stand for.
template <int Dim, class Use>
void for_each_point_of_piece(const typename FreeSurface<Dim>::Piece& piece, const Use& use) {
  constexpr double share = 1.0 / FreeSurface<Dim>::covers;
  for (const auto& element : piece.elements)
    for_each_point<Dim>(element, [&](const Vec<Dim>& x, double area) { use(x, share * area); });
}

}  // namespace minamo
