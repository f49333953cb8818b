#pragma once
/// \file
/// Tension of the free surface: what a scene says of it, the surface that a step finds, and its forces.

#include "components/staggered.hpp"

namespace minamo {

struct SurfaceTension {
  double coefficient = 0;              ///< sigma [N/m]
  double cosine_of_contact_angle = 0;  ///< of the angle in the liquid, between wall and surface [1]
  static constexpr ComponentInfo info{"surface_tension", "sigma, cos theta", "N/m, 1", Lifetime::constant};
};

/// The free surface in the middle of the step: segments in the plane, triangles in space, each by itself.
template <int Dim>
struct FreeSurface {
  /// Between two nodes of the lattice that the surface is found on, at (1 - share) x_in + share x_out.
  struct Corner {
    Vec<Dim> x;  ///< [m]
    Index<Dim> in;
    Index<Dim> out;
    double share;
  };
  /// A segment with the liquid to its left, or a triangle, counterclockwise seen from outside.
  using Element = std::array<Corner, static_cast<std::size_t>(Dim)>;
  /// Where an element meets a side of the box: in a point in the plane, along a segment in space.
  struct Contact {
    std::array<Corner, static_cast<std::size_t>(Dim) - 1> corner;
    Vec<Dim> outward;  ///< along the side, across the contact line, off what is wet [1]
  };
  /// What is found side by side. Which piece holds what does not depend on the number of threads.
  struct Piece {
    std::vector<Element> elements;
    std::vector<Contact> contacts;
    double area = 0;    ///< length in the plane [m^(d-1)]
    double wetted = 0;  ///< area of the sides of the box under the liquid [m^(d-1)]
  };
  std::vector<Piece> pieces;
  double area = 0;    ///< of all pieces [m^(d-1)]
  double wetted = 0;  ///< [m^(d-1)]
  static constexpr ComponentInfo info{"surface.elements", "", "m", Lifetime::scratch};
};

namespace surface {

/// Signed distance from the free surface, positive in the liquid, up to the reach of quadratic splines; at their
/// centroids. [m]
struct Distance : Column<Staggered, double> {
  static constexpr ComponentInfo info{"surface.distance", "psi_i", "m", Lifetime::scratch};
};

/// How much of the surface is around a quadratic spline. [m^(d-1)]
struct Around : Column<Staggered, double> {
  static constexpr ComponentInfo info{"surface.around", "A_i", "m^(d-1)", Lifetime::scratch};
};

/// Force of what is around a quadratic spline, per area of the surface. [N/m^(d-1)]
template <int Dim>
struct Traction : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"surface.traction", "t_i", "N/m^(d-1)", Lifetime::scratch};
};

}  // namespace surface

namespace face {

/// Directions whose face takes forces of the surface, bit d for direction d. [1]
struct TakesSurfaceForce : Column<Staggered, std::uint8_t> {
  static constexpr ComponentInfo info{"face.takes_surface_force", "", "1", Lifetime::scratch};
};

/// Force of the surface tension. [N]
template <int Dim>
struct SurfaceForce : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.surface_force", "F_f", "N", Lifetime::scratch};
};

}  // namespace face
}  // namespace minamo
