#pragma once
/// \file
/// (E110) Friction of the cells that bodies cut: the matrices K^_c over what is open of them, and friction at walls
/// with a slip length. In scenes in which a body rubs, or where friction is in the balances.

#include "components/body.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/viscosity/cut_friction.hpp"

namespace minamo {

/// Of the cells of the grid that bodies at rest cut; those that moving ones cut are found in every step.
template <int Dim>
FrictionAtRest<Dim> friction_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines);

/// Largest memory that friction of cut cells takes: that of all bodies where they are at the start. [byte]
template <int Dim>
double cut_friction_bytes(const BodySet<Dim>& set, const Grid<Dim>& grid, int degree);

template <int Dim>
struct FindCutFriction {
  static constexpr Doc doc = "(E110) friction matrices of cells that bodies cut";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                  Uses<BodyPlacement<Dim>> placement, Read<FrictionAtRest<Dim>> at_rest,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b,
                  Write<CutFriction<Dim>> cut) const;
};

}  // namespace minamo
