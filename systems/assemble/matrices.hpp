#pragma once
/// \file
/// The matrices of the discrete equations, as stencil rows of the active nodes, from the moments of the cells.

#include "components/fluid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/assemble/moments.hpp"

namespace minamo {

/// (E21)  D_IJ = sum_p V_p S_I grad S_J.
template <int Dim>
struct AssembleDivergence {
  static constexpr std::string_view doc = "(E21) D_IJ";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments, Read<node::Row> row,
                  Write<matrix::Divergence<Dim>> divergence) const;
};

/// (E22)  L_IJ = sum_p V_p grad S_I . grad S_J.
template <int Dim>
struct AssembleLaplacian {
  static constexpr std::string_view doc = "(E22) L_IJ";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments, Read<node::Row> row,
                  Write<matrix::Laplacian<Dim>> laplacian) const;
};

/// (E23)  K_IJ = mu sum_p V_p [(grad S_I . grad S_J) 1 + grad S_J (x) grad S_I]: the force of 2 mu D on node I.
template <int Dim>
struct AssembleViscosity {
  static constexpr std::string_view doc = "(E23) K_IJ";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments, Read<Fluid> fluid,
                  Read<node::Row> row, Write<matrix::Viscosity<Dim>> viscosity) const;
};

/// (E22)  L_IJ = tr K_IJ/((d + 1) mu): cheaper than L where K is there already.
template <int Dim>
struct LaplacianFromViscosity {
  static constexpr std::string_view doc = "(E22) L_IJ, from K_IJ";
  void operator()(Read<Fluid> fluid, Read<matrix::Viscosity<Dim>> viscosity,
                  Write<matrix::Laplacian<Dim>> laplacian) const;
};

}  // namespace minamo
