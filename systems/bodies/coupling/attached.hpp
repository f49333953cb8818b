#pragma once
/// \file
/// (E94) Liquid that the faces of the grid do not see: between a wall and the nearest face in front of it.

#include "components/body.hpp"
#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/splines.hpp"

namespace minamo {

/// (E94)  m_f = rho V_f (O_f - a_f) of the nearest body where the liquid around is full.
template <int Dim>
struct FindAttachedMass {
  static constexpr std::string_view doc = "(E94) mass of the liquid that moves with a body";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid, Read<BodySet<Dim>> set,
                  Read<body::MiddlePosition<Dim>> c_b, Read<body::MiddleRotation<Dim>> R_b,
                  Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour,
                  Read<face::Open<Dim>> open, Read<face::OpenVolume<Dim>> open_volume,
                  Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi,
                  Optional<Read<face::Density<Dim>>> rho_f, Write<face::AttachedMass<Dim>> mass,
                  Write<face::AttachedTo<Dim>> body) const;
};

}  // namespace minamo
