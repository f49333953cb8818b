#pragma once
/// \file
/// Tension of the free surface: what a scene says of it, the surface that a step finds, and its forces.

#include "components/rigid.hpp"
#include "components/staggered.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace minamo {

struct SurfaceTension {
  /// What a body does to a free surface that meets it.
  struct Wall {
    double cosine_of_contact_angle = 0;  ///< [1]
    bool sticks = false;                 ///< where the liquid does not slip, the contact line does not move
  };
  double coefficient = 0;  ///< sigma [N/m]
  double cosine_of_contact_angle =
      0;                     ///< of the angle in the liquid, between wall and surface, at sides of the box [1]
  std::vector<Wall> bodies;  ///< by body
  static constexpr ComponentInfo info{"surface_tension", "sigma, cos theta", "N/m, 1", Lifetime::constant};
};

/// The free surface in the middle of the step: segments in 2-D, polygons in 3-D, each by itself.
template <int Dim>
struct FreeSurface {
  /// How many times the elements cover the surface: in 3-D cubes are divided in two ways, which together prefer no
  /// diagonal.
  static constexpr int covers = Dim == 2 ? 1 : 2;
  struct Areas {
    double free = 0;              ///< of the surface, its length in 2-D [m^(d-1)]
    double wetted = 0;            ///< of the sides of the box under the liquid [m^(d-1)]
    double wetted_of_bodies = 0;  ///< [m^(d-1)]
    double gained = 0;            ///< sum of what is wetted times the cosine of its contact angle [m^(d-1)]

    Areas& operator+=(const Areas& other) {
      free += other.free;
      wetted += other.wetted;
      wetted_of_bodies += other.wetted_of_bodies;
      gained += other.gained;
      return *this;
    }
  };
  /// Between two nodes of the lattice that the surface is found on, at (1 - share) x_in + share x_out.
  struct Corner {
    Vec<Dim> x;  ///< [m]
    Index<Dim> in;
    Index<Dim> out;
    double share;
    std::int32_t on_body = staggered::none;  ///< place in Piece::on_bodies of a corner on a body
  };
  /// A corner on a body, where what lies between two corners ends: at (1 - part) of the one and `part` of the other,
  /// which lies between the two nodes given here.
  struct OnBody {
    Index<Dim> in;
    Index<Dim> out;
    double share;
    double part;
    Vec<Dim> normal;  ///< of the body [1]
    std::int32_t body;
  };
  /// A segment with the liquid to its left, or a flat convex polygon, counterclockwise seen from outside.
  class Element {
   public:
    /// What a plane cuts from a tetrahedron has four corners at most, and another plane adds one.
    static constexpr std::size_t most = Dim == 2 ? 2 : 5;

    bool counts = true;  ///< in sums over all ranks: one on the edge of a rank others have, too

    void push_back(const Corner& corner) { corner_[size_++] = corner; }
    void turn_around() { std::reverse(begin(), end()); }

    std::size_t size() const { return size_; }
    Corner& operator[](std::size_t k) { return corner_[k]; }
    const Corner& operator[](std::size_t k) const { return corner_[k]; }
    Corner* begin() { return corner_.data(); }
    Corner* end() { return corner_.data() + size_; }
    const Corner* begin() const { return corner_.data(); }
    const Corner* end() const { return corner_.data() + size_; }

   private:
    std::array<Corner, most> corner_;
    std::size_t size_ = 0;
  };
  /// Where an element meets a side of the box or a body: in a point in 2-D, along a segment in 3-D.
  struct Contact {
    std::array<Corner, static_cast<std::size_t>(Dim) - 1> corner;
    Vec<Dim> outward;  ///< along the wall, across the contact line, off what is wet [1]
    std::int32_t body = staggered::none;
    bool counts = true;  ///< as Element::counts
  };
  /// What is found side by side. Which piece holds what does not depend on the number of threads.
  struct Piece {
    std::vector<Element> elements;
    std::vector<Contact> contacts;
    std::vector<OnBody> on_bodies;
    Areas areas;
  };
  std::vector<Piece> pieces;
  Areas areas;  ///< of all pieces
  static constexpr ComponentInfo info{"surface.elements", "", "m", Lifetime::scratch};
};

/// What the pieces of the surface bring to sites, before it is added up one piece after the other. Of a block of sites
/// around a cell all have a place.
template <int Dim>
struct PieceSums {
  template <class Value>
  struct Blocks {
    std::vector<Index<Dim>> cell;
    std::vector<std::int32_t> row;
    std::vector<Value> value;
  };
  std::vector<Blocks<double>> areas;
  std::vector<Blocks<Vec<Dim>>> forces;
  std::vector<std::vector<std::pair<std::uint32_t, Vec<Dim>>>> at_corners;
  std::vector<std::vector<std::pair<std::uint32_t, RigidVector<Dim>>>> on_bodies;
  static constexpr ComponentInfo info{"surface.piece_sums", "", "", Lifetime::cache};
};

/// Distances of the bodies at rest at all sites of the grid, x fastest, none if there is none. [m]
struct SolidAtRest {
  std::vector<double> distance;
  static constexpr ComponentInfo info{"surface.solid_at_rest", "", "m", Lifetime::constant};
};

namespace surface {

/// Signed distance from the free surface, positive in the liquid, up to the reach of quadratic splines; at their
/// centroids. [m]
struct Distance : Column<Staggered, double> {
  static constexpr ComponentInfo info{"surface.distance", "psi_i", "m", Lifetime::scratch};
};

/// Of the centroid of a quadratic spline to the nearest body, negative inside; far away more than it could reach. [m]
struct SolidDistance : Column<Staggered, double> {
  static constexpr ComponentInfo info{"surface.solid_distance", "", "m", Lifetime::scratch};
};

/// What bodies leave open of a quadratic spline. [1]
struct OpenShare : Column<Staggered, double> {
  static constexpr ComponentInfo info{"surface.open_share", "", "1", Lifetime::scratch};
};

/// From the centroid of a quadratic spline to that of what bodies leave open of it. [m]
template <int Dim>
struct OpenCentroid : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"surface.open_centroid", "", "m", Lifetime::scratch};
};

/// Distance from the free surface there. [m]
struct OpenDistance : Column<Staggered, double> {
  static constexpr ComponentInfo info{"surface.open_distance", "psi'_i", "m", Lifetime::scratch};
};

/// Forces of contact lines on the bodies, and their moments, by body. [N, N m]
template <int Dim>
struct ForceOnBodies {
  std::vector<RigidVector<Dim>> of;
  static constexpr ComponentInfo info{"surface.force_on_bodies", "", "N, N m", Lifetime::scratch};
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
