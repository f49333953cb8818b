#pragma once
/// \file
/// (E112) The free surface as a step computes with it, from how full of liquid quadratic splines are. The surface of
/// frames (systems/output/surface) is another: finer, closed at walls, around the liquid's volume.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/particle.hpp"
#include "components/surface_tension.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// Distance from a plane, in units of h, on whose one side a quadratic spline has a fraction of its integral: the
/// inverse of quadratic_spline_below(). \pre 0 <= fraction <= 1
double distance_of_fill(double fraction);

/// (E112)  psi_i = h F^-1(phi_i), phi_i = sum_p N_i V_p/V_i.
template <int Dim>
struct FindSurfaceDistance {
  static constexpr Doc doc = "(E112) psi_i, distance from the free surface";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Volume> V_p, Read<staggered::Site<Dim>> site, Optional<Read<SiteExchange>> shared,
                  Write<surface::Distance> psi) const;
};

/// (E112)  Where psi, linear in triangles or tetrahedra, is zero; (E121) outside of bodies.
template <int Dim>
struct FindFreeSurface {
  static constexpr Doc doc = "(E112) segments or triangles of the free surface, contact lines";
  void operator()(Read<SurfaceTension> tension, Read<Grid<Dim>> grid, Read<StaggeredIndex<Dim>> rows,
                  Read<staggered::Site<Dim>> site, Read<surface::Distance> psi, Read<Splines<Dim>> splines,
                  Optional<Read<surface::SolidDistance>> solid, Optional<Read<surface::OpenShare>> open,
                  Optional<Read<surface::OpenCentroid<Dim>>> centroid, Optional<Read<surface::OpenDistance>> open_psi,
                  Optional<Read<BodySet<Dim>>> set, Optional<Read<body::MiddlePosition<Dim>>> c_b,
                  Optional<Read<body::MiddleRotation<Dim>>> R_b, Optional<Read<SiteExchange>> shared,
                  Write<FreeSurface<Dim>> surface) const;
};

}  // namespace minamo
