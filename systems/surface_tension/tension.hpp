#pragma once
/// \file
/// (E113) (E114) What the tension of the free surface does to the faces, and (E115) its energy. The force is the
/// virtual work of the surface, whose corners move by means of the velocity over the surface around them.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "components/surface_tension.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// dA/dx of the corners of an element, one after the other. [m^(d-2)]
template <int Dim>
using AreaGradient = std::array<Vec<Dim>, FreeSurface<Dim>::Element::most>;
template <int Dim>
AreaGradient<Dim> area_gradient(const typename FreeSurface<Dim>::Element& element);

/// (E113)  A_i = integral of N_i over the surface.
template <int Dim>
struct MeasureSurfaceAround {
  static constexpr Doc doc = "(E113) A_i, surface around quadratic splines";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<FreeSurface<Dim>> surface, Update<PieceSums<Dim>> sums, Write<surface::Around> A_i) const;
};

/// (E113) (E114)  t_i = sum_v R_vi (-sigma dA/dx_v + sigma cos theta dW/dx_v)/A_i; what walls take of it, of bodies
/// the forces (E121).
template <int Dim>
struct FindSurfaceTraction {
  static constexpr Doc doc = "(E113) (E114) (E121) t_i of surface and contact lines";
  void operator()(Read<SurfaceTension> tension, Read<Grid<Dim>> grid, Read<Walls<Dim>> walls,
                  Read<StaggeredIndex<Dim>> rows, Read<FreeSurface<Dim>> surface, Read<surface::Around> A_i,
                  Optional<Read<body::MiddlePosition<Dim>>> c_b, Optional<Read<SiteExchange>> shared,
                  Update<PieceSums<Dim>> sums, Write<surface::Traction<Dim>> t_i,
                  Write<surface::ForceOnBodies<Dim>> F_b) const;
};

/// (E113)  F_f = integral of N_f sum_i N_i t_i over the surface; v*_f gets tau F_f/m_f. (E121) Near bodies E^T F_f.
template <int Dim>
struct AddSurfaceTension {
  static constexpr Doc doc = "(E113) F_f of surface tension";
  void operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<StaggeredIndex<Dim>> rows, Read<face::Held> held,
                  Read<multiplier::Row> row, Read<FreeSurface<Dim>> surface, Read<surface::Traction<Dim>> t_i,
                  Read<face::Mobility<Dim>> mobility, Optional<Read<face::Open<Dim>>> open,
                  Optional<Read<FaceExtension<Dim>>> extension, Update<PieceSums<Dim>> sums,
                  Write<face::TakesSurfaceForce> takes, Write<face::SurfaceForce<Dim>> F_f,
                  Update<face::Predictor<Dim>> predictor) const;
};

/// (E115)  sigma (A - cos theta W), taken from the middle of the step to its end by the work of the forces.
template <int Dim>
struct MeasureSurfaceEnergy {
  static constexpr Doc doc = "(E115) surface energy at the end of the step";
  void operator()(Read<SurfaceTension> tension, Read<FreeSurface<Dim>> surface, Read<Grid<Dim>> grid,
                  Read<particle::Volume> V_p, Read<face::SurfaceForce<Dim>> F_f, Read<face::Displacement<Dim>> u_f,
                  Optional<Read<SiteExchange>> shared, Update<measure::Energy> energy,
                  Update<measure::Columns> columns) const;
};

/// The same where nothing has moved yet.
template <int Dim>
struct MeasureSurfaceEnergyAtStart {
  static constexpr Doc doc = "(E115) surface energy at the start";
  void operator()(Read<SurfaceTension> tension, Read<FreeSurface<Dim>> surface, Read<Grid<Dim>> grid,
                  Read<particle::Volume> V_p, Optional<Read<SiteExchange>> shared, Update<measure::Energy> energy,
                  Update<measure::Columns> columns) const;
};

}  // namespace minamo
