#pragma once
/// \file
/// (E112) (E121) What of the free surface lies in a cube of the lattice that it is found on: between the nodes, linear
/// in triangles or tetrahedra, and outside of bodies, whose distance is linear there, too. They prefer no side, so that
/// a drop is the same in the mirror.

#include "components/surface_tension.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/shapes/simplices.hpp"
#include "systems/surface_tension/near_bodies.hpp"
#include "systems/surface_tension/surface_lattice.hpp"

namespace minamo {

/// Side 2 d or 2 d + 1 of the box as a bit.
using SidesOfBox = unsigned;

/// The bodies of a step, as the surface meets them.
template <int Dim>
struct SurfaceBodies {
  PlacedBodies<Dim> placed;
  const std::vector<SurfaceTension::Wall>& walls;

  const DistanceAround<Dim>& around;

  typename PlacedBodies<Dim>::Nearest nearest(const Vec<Dim>& x) const {
    const auto resting = placed.nearest(x, false);
    const auto moving = placed.nearest(x, true);
    return moving.distance < resting.distance ? moving : resting;
  }
};

template <int Dim>
class SurfaceCube {
 public:
  using Surface = FreeSurface<Dim>;
  using Piece = typename Surface::Piece;
  static constexpr std::size_t corners = power(2, Dim);

  /// \param psi             by row of the sites [m]
  /// \param outside         psi where there is no row [m]
  /// \param base            the lowest of its nodes
  /// \param bodies          null where none is near
  /// \param cosine_of_sides of the contact angle at the sides of the box
  SurfaceCube(const SurfaceLattice<Dim>& lattice, std::span<const double> psi, double outside, const Index<Dim>& base,
              const SurfaceBodies<Dim>* bodies, double cosine_of_sides);

  void add_to(Piece& piece) const;

 private:
  using Simplex = std::array<std::size_t, static_cast<std::size_t>(Dim) + 1>;
  using Simplices = decltype(simplices_of_box<Dim>());
  /// Which diagonal of a square is higher, psi in the middle of it.
  enum class Bend { none, along_first, along_second };
  struct Node {
    Vec<Dim> x;
    Index<Dim> at;
    double psi = 0;     ///< [m]
    double solid = 0;   ///< distance from bodies, where there are any near [m]
    SidesOfBox on = 0;  ///< sides that it lies on
  };
  struct Corner {
    typename Surface::Corner place;
    SidesOfBox on;
    double solid;  ///< [m]
  };
  /// Of a segment or a polygon.
  struct Corners {
    std::array<Corner, Surface::Element::most> at;
    std::size_t count = 0;

    void push_back(const Corner& corner) { at[count++] = corner; }
  };
  /// Directions in a simplex.
  struct Slopes {
    Vec<Dim> out;                          ///< across the surface, to where there is no liquid
    Vec<Dim> off_body = Vec<Dim>::Zero();  ///< unit, normal of the body
  };

  void find_bodies(const SurfaceBodies<Dim>& bodies);
  Bend bend() const requires(Dim == 2);
  void add_of(const Simplex& simplex, Piece& piece) const;
  void add_along(const Simplices& triangles, Piece& piece) const requires(Dim == 2);
  void add_undivided(Piece& piece) const requires(Dim == 2);
  void add_wetted(Piece& piece) const;
  void add_wetted(const Simplex& simplex, SidesOfBox side, Piece& piece) const;
  void add_wetted_of_body(Simplex corner, Piece& piece) const;
  Corner between(std::size_t in, std::size_t out) const;
  Vec<Dim> gradient(const Simplex& corner, double Node::*value) const;
  Slopes slopes(const Simplex& corner, std::size_t inside) const;
  void cut(Simplex corner, Piece& piece) const;
  void add_outside_of_bodies(Piece& piece, const Slopes& slopes, const Corners& outline) const;
  void add(Piece& piece, const Slopes& slopes, const Corners& outline) const;
  template <class IsOn>
  void add_contacts(Piece& piece, const Corners& outline, const Vec<Dim>& normal, const Vec<Dim>& out,
                    std::int32_t body, const IsOn& is_on) const;

  std::array<Node, corners> node_;
  bool is_cut_;
  bool meets_wall_;
  bool has_body_ = false;  ///< whether a node lies in a body
  std::int32_t body_ = staggered::none;
  double cosine_of_body_ = 0;
  double cosine_of_sides_;
};

/// Normal of a segment, to its right, or of a polygon, as long as the one and as large as the other. [m^(d-1)]
template <int Dim>
Vec<Dim> area_vector(const typename FreeSurface<Dim>::Element& element);
/// Length of a segment, area of a polygon. [m^(d-1)]
template <int Dim>
double area_of(const typename FreeSurface<Dim>::Element& element) {
  return area_vector<Dim>(element).norm();
}

/// Share of a segment (N = 2) or triangle (3) on which two functions, linear in between the corners, are both positive.
template <std::size_t N>
double positive_share_of_both(const std::array<double, N>& first, const std::array<double, N>& second);

}  // namespace minamo
