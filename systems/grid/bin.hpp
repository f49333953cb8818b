#pragma once
/// \file
/// Sorts particles by the cell that they are in.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"

namespace minamo {

/// Sorts particles by the dual cell of y_p, blocks of cells first; particles of one cell keep their order.
template <int Dim>
struct Bin {
  static constexpr Doc doc = "sort particles by dual cell, colour the blocks of cells";
  void operator()(Read<Grid<Dim>> grid, Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles,
                  Write<OccupiedCells<Dim>> cells, Resize<Cells> rows, Update<BinBuffer> buffer) const;
};

/// The same by the cell of y_p, for the conforming discretization.
template <int Dim>
struct BinByCell {
  static constexpr Doc doc = "sort particles by cell, colour the blocks of cells";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<particle::QuadraturePosition<Dim>> y_p,
                  Resize<Particles> particles, Write<GridCells<Dim>> cells, Resize<Cells> rows,
                  Update<BinBuffer> buffer) const;
};

}  // namespace minamo
