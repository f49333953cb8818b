#pragma once
/// \file
/// The staggered grid as one parameter of systems.

#include "components/grid.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"

namespace minamo {

/// Velocities on faces, multipliers in between (F. H. Harlow, J. E. Welch, Phys. Fluids 8 (1965) 2182).
template <int Dim>
struct MacGrid {
  Read<Grid<Dim>> grid;                       ///< of cells
  Read<Splines<Dim>> splines;                 ///< N_f, N_l
  Read<staggered::Site<Dim>> site;            ///< of a row
  Read<staggered::Neighbour<Dim>> neighbour;  ///< rows next to a row
};

}  // namespace minamo
