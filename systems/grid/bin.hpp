#pragma once
/// \file
/// Sorts particles by dual cell.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/system.hpp"

namespace minamo {

/// Sorts particles by the dual cell of y_p, blocks of cells first; particles of one cell keep their order.
template <int Dim>
struct Bin {
  static constexpr std::string_view doc = "sort particles by dual cell, colour the blocks of cells";
  void operator()(Read<Grid<Dim>> grid, Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles,
                  Write<OccupiedCells<Dim>> cells, Resize<Cells> rows, Update<BinBuffer> buffer) const;
};

}  // namespace minamo
