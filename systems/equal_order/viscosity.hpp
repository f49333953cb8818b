#pragma once
/// \file
/// The friction of a Newtonian liquid, as stencil rows of the active nodes, from the moments of the cells.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/equal_order/moments.hpp"

namespace minamo {

/// (E23)  K_IJ = sum_p mu V_p [(grad S_I . grad S_J) 1 + grad S_J (x) grad S_I]: the force of 2 mu D on node I.
/// (E51)  + sum_p tau_2 V_p grad S_I (x) grad S_J where cells have a bulk viscosity.
/// And T_IJ of the stabilization, as AssembleLaplacian: its cell matrices are among those of K_IJ.
template <int Dim>
struct AssembleViscosity {
  static constexpr Doc doc = "(E22) (E23) (E51) K_IJ; T_IJ";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments,
                  Read<cell::Viscosity> mu_c, Optional<Read<cell::BulkViscosity>> tau_2, Read<cell::Tau> tau_c,
                  Read<node::Row> row, Write<matrix::Viscosity<Dim>> viscosity,
                  Update<matrix::Stabilization<Dim>> stabilization) const;
};

}  // namespace minamo
