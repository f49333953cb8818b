#pragma once
/// \file
/// Triangles that close around a solid, and the normals that tell its inside from its outside.

#include "systems/shapes/mesh_file.hpp"

namespace minamo::shapes {

/// Normals of length 1, or 0 where triangles have no area. (Baerentzen, Aanaes, Signed Distance Computation Using the
/// Angle Weighted Pseudonormal, IEEE TVCG 11, 2005)
struct ClosedSurface {
  std::vector<Vec<3>> corner;  ///< every place once [m]
  std::vector<std::array<std::uint32_t, 3>> triangle;
  std::vector<std::array<std::uint32_t, 3>> edge;  ///< of a triangle, from its corner k to the next
  std::vector<Vec<3>> triangle_normal;
  std::vector<Vec<3>> edge_normal;    ///< mean of the two triangles
  std::vector<Vec<3>> corner_normal;  ///< mean of the triangles, weighted with their angles
  double volume = 0;                  ///< [m^3]
  bool was_inward = false;            ///< and has been turned round
};

/// x = scale X + move of the corners of a file. Corners at one place become one; triangles that thereby lose a corner
/// are left out. If the triangles turn inward as a whole, which makes the volume negative, all are turned round.
/// Not looked for: a surface that cuts through itself.
/// \throws MeshError unless every edge has two triangles that turn the same way, and the volume is not zero.
ClosedSurface close_surface(const Triangles& mesh, double scale, const Vec<3>& move);

}  // namespace minamo::shapes
