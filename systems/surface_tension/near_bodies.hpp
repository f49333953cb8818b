#pragma once
/// \file
/// (E121) The distance from the free surface near bodies, where splines are cut and no particle tells of the other
/// side.

#include "components/body.hpp"
#include "components/surface_tension.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/grid/splines.hpp"
#include "systems/surface_tension/surface_lattice.hpp"

namespace minamo {

/// What a wall leaves of a quadratic B-spline, the wall at a distance from its middle, both in units of h.
struct OpenSpline {
  double share;     ///< [1]
  double centroid;  ///< of what is left, away from the wall [h]
};
/// \param distance  negative where the middle lies in the wall
OpenSpline open_spline(double distance);

/// Of the bodies at rest of a scene.
template <int Dim>
SolidAtRest solid_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines);

/// (E121)  The distance from the free surface at a site, from those around it that tell of the liquid.
template <int Dim>
struct DistanceAround {
  const Grid<Dim>& grid;
  const Splines<Dim>& splines;
  const SurfaceLattice<Dim>& lattice;
  std::span<const double> open;  ///< by row, as surface::OpenShare, and so on
  std::span<const Vec<Dim>> centroid;
  std::span<const double> psi;

  /// psi_i at the centroid of its quadratic spline. [m]
  double at(const Index<Dim>& site) const;
};

/// (E121)  psi'_i = h F^-1(phi_i/O_i) at the centroid of what is open; psi_i of the linear function nearest to those
/// around.
template <int Dim>
struct ExtendSurfaceDistance {
  static constexpr Doc doc = "(E121) psi_i near bodies and in them";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<SolidAtRest> at_rest, Uses<BodyPlacement<Dim>> placement, Read<staggered::Site<Dim>> site,
                  Write<surface::SolidDistance> solid, Write<surface::OpenShare> open,
                  Write<surface::OpenCentroid<Dim>> centroid, Write<surface::OpenDistance> open_psi,
                  Update<surface::Distance> psi) const;
};

}  // namespace minamo
