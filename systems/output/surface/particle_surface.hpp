#pragma once
/// \file
/// (E111) The free surface, found between particles: closed lines in 2-D, closed triangle meshes in 3-D. It is
/// written, not computed with.

#include "components/grid.hpp"
#include "systems/shapes/outline.hpp"

#include <functional>
#include <span>

namespace minamo {

template <int Dim>
struct ParticleSurface {
  Outline<Dim> outline;
  std::vector<Vec<Dim>> velocity;  ///< of the liquid at every point [m/s]
};

/// What the surface is found between; spans have a number per particle.
template <int Dim>
struct SurfaceOf {
  Bounds<Dim> box;     ///< where the liquid may be [m]
  double spacing = 0;  ///< of the particles as they were laid out [m]
  std::span<const Vec<Dim>> position;
  std::span<const Vec<Dim>> velocity;
  std::span<const double> volume;
  /// Signed distance to the nearest body; empty without bodies. [m]
  std::function<double(const Vec<Dim>&)> distance_to_bodies;
};

/// (E111)  The surface of what is half full of liquid and more; walls and bodies cut it off. What a particle alone does
/// not fill by half becomes a drop of its volume: a polygon of twelve corners, an icosahedron.
/// \return points and elements in an order that depends on the particles' alone
template <int Dim>
ParticleSurface<Dim> surface_of(const SurfaceOf<Dim>& of);

/// Memory that it takes for a while, about: 1 + Dim numbers of 4 bytes per point of a lattice as fine as the particles.
/// [byte]
template <int Dim>
double surface_bytes(const Bounds<Dim>& box, double spacing);

}  // namespace minamo
