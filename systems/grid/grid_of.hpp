#pragma once
/// \file
/// The grid that a scene asks for.

#include "components/grid.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

template <int Dim>
Grid<Dim> grid_of(const GridScene& scene) {
  Grid<Dim> grid;
  grid.spacing = scene.spacing;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    grid.low[axis] = scene.low[d];
    grid.high[axis] = scene.high[d];
    grid.cells[d] = scene.cells[d];
    grid.periodic[d] = scene.periodic[d];
  }
  return grid;
}

}  // namespace minamo
