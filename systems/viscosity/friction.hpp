#pragma once
/// \file
/// Friction of the conforming discretization: the viscosity of cells, and friction that is known at the start of the
/// step, for liquids that flow so easily that no matrix is needed.

#include "components/body.hpp"
#include "components/fluid.hpp"
#include "components/friction.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/momentum/face_extension.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/viscosity/cut_friction.hpp"
#include "systems/viscosity/friction_matrices.hpp"

namespace minamo {

/// (E80)  mu_c = mu sum_p V_p/h^d over the particles of a cell; mu where all around is full of liquid.
template <int Dim>
struct FindCellViscosity {
  static constexpr Doc doc = "(E80) mu_c, what of a cell is liquid";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid, Read<GridCells<Dim>> cells,
                  Read<CellSites> sites, Read<particle::Volume> V_p, Read<multiplier::FillAround> around,
                  Optional<Read<CutFriction<Dim>>> cut, Optional<Read<FrictionAtRest<Dim>>> at_rest,
                  Write<cell::Viscosity> mu_c) const;
};

/// (E81)  v*_f -= tau (K v°)_f/m_f, K = sum_c theta_c mu_c K^_c, theta_c = min(1, m_f/(2 tau D_f)) over the faces of
/// the cell, D_f = sum_c mu_c sum_g |K^_fg|. Then 2 tau K <= m, and 1 - 2 tau m^-1 K of the midpoint rule lies between
/// 0 and 1 for every viscosity and every mass: energy never rises. theta_c is 1 but in cells with faces that next to no
/// particles touch. By cells, so that momentum and angular momentum stay. Near bodies that rub by (E110).
template <int Dim>
struct RubFaces {
  static constexpr Doc doc = "(E81) friction at the start of the step, of liquids that flow easily";
  void operator()(Read<Rates> rates, Read<Splines<Dim>> splines, Read<FrictionMatrices<Dim>> matrices,
                  Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<face::Mobility<Dim>> mobility,
                  Optional<Read<face::Open<Dim>>> open, Optional<Read<FaceExtension<Dim>>> extension,
                  Optional<Read<CutFriction<Dim>>> cut, Optional<Read<FrictionAtRest<Dim>>> at_rest,
                  Optional<Read<SiteExchange>> shared, Update<cell::Viscosity> mu_c,
                  Write<face::FrictionBound<Dim>> bound, Write<face::Friction<Dim>> friction,
                  Write<FrictionOnWalls<Dim>> on_walls, Update<face::Predictor<Dim>> predictor) const;
};

}  // namespace minamo
