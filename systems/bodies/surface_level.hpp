#pragma once
/// \file
/// (E122) Mass of faces beside bodies near the free surface. Water rests only if faces on the same level of its surface
/// are equally full: what is left of gravity turns it around for ever. Particles in what a body leaves of a face tell
/// that to a tenth, those of whole faces nearby tell it exactly.

#include "components/body.hpp"
#include "components/staggered.hpp"
#include "systems/conforming/splines.hpp"

namespace minamo {

/// The faces of one direction.
template <int Dim>
struct FacesOnLevels {
  const Splines<Dim>& splines;
  const SiteRows<Dim>& rows;
  std::span<const Index<Dim>> site;
  std::span<const Vec<Dim>> open_volume;
  std::size_t direction;
  double full_cell;  ///< mass of a cell full of liquid [kg]
};

/// (E122)
/// \param cut   rows of faces that bodies cut
/// \param mass  by row and direction; that of faces that are cut as if they were whole, estimated from their own
///              particles before, from the whole faces on their level after [kg]
template <int Dim>
void level_with_surface(const FacesOnLevels<Dim>& faces, std::vector<std::uint32_t> cut, std::span<Vec<Dim>> mass);

}  // namespace minamo
