#pragma once
/// \file
/// Grids for what finds nodes by their sites.

#include "components/grid.hpp"

namespace minamo::kernels {

/// Around in x, between walls in y and z. Pages of all kinds: whole ones, cut ones, a single one along an axis.
template <int Dim>
Grid<Dim> long_grid() {
  Grid<Dim> grid;
  constexpr std::array<int, 3> cells{61, 18, 7};
  for (std::size_t d = 0; d < Dim; ++d) grid.cells[d] = cells[d];
  grid.periodic[0] = true;
  return grid;
}

}  // namespace minamo::kernels
