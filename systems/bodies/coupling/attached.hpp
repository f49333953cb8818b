#pragma once
/// \file
/// (E94) Liquid that the faces of the grid do not see: between a wall and the nearest face in front of it.

#include "components/body.hpp"
#include "components/fluids.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/mac_grid.hpp"

namespace minamo {

/// (E94)  m_f = rho V_f (O_f - a_f) of the nearest body where the liquid around is full.
template <int Dim>
struct FindAttachedMass {
  static constexpr Doc doc = "(E94) mass of the liquid that moves with a body";
  void operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Uses<BodyPlacement<Dim>> placement,
                  Read<face::Open<Dim>> open, Read<face::OpenVolume<Dim>> open_volume,
                  Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi,
                  Optional<Read<face::Density<Dim>>> rho_f, Write<face::AttachedMass<Dim>> mass,
                  Write<face::AttachedTo<Dim>> body) const;
};

}  // namespace minamo
