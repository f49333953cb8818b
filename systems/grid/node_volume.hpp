#pragma once
/// \file
/// Volume around nodes: of the grid, and of the particles.

#include "systems/grid/place.hpp"

#include <span>

namespace minamo {

/// (E39)  V_I, the integral of S_I over the box: h^d, times 13/24 on a wall and 23/24 beside it. [m^3; m^2 in 2-D]
template <int Dim>
double full_volume(const Grid<Dim>& grid, std::size_t node) {
  double volume = 1;
  for (int d = 0; d < Dim; ++d) {
    const auto nodes = static_cast<std::size_t>(grid.nodes(d));
    const auto axis = static_cast<std::size_t>(d);
    volume *= grid.spacing;
    if (!grid.periodic[axis]) volume *= axis_integral(static_cast<int>(node % nodes), grid.cells[axis]);
    node /= nodes;
  }
  return volume;
}

/// (E35)  V~_I = sum_p S_I(x_p) V_p, wherever the particles are. One after the other: they may have left the cells that
/// they are sorted by.
template <int Dim>
void gather_node_volume(const Grid<Dim>& grid, double density, std::span<const Vec<Dim>> x_p,
                        std::span<const double> m_p, std::span<double> v_i) {
  std::fill(v_i.begin(), v_i.end(), 0.0);
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const double v = m_p[p] / density;
    const Place<Dim> place(grid, x_p[p]);
    for_each_support<Dim>(
        [&](std::size_t k, const Index<Dim>& offset) { v_i[place.support.node[k]] += place.weights(offset) * v; });
  }
}

}  // namespace minamo
