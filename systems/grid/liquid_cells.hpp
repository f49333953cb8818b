#pragma once
/// \file
/// Where particles are liquid, and where they are spray, with nodes of their own.

#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/node.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/node_support.hpp"

namespace minamo {

/// w_c of (E61) from f_c.
double liquid_indicator(double fill_fraction);
/// b_c of (E61) from f_c.
double bulk_indicator(double fill_fraction);

/// (E61)  w_c = min(1, max(0, 5 f_c - 1.5)), f_c = sum_J m_J / (rho sum_J V_J) over the nodes of a dual cell, V_J
/// (E39). A cell full of particles that is alone has f_c = 0.1 to 0.24, one at a corner of a body 0.44, one in a film
/// as thick as a cell 0.49 and more, one at a surface 0.66. b_c = min(1, max(0, 2.5 f_c - 1.25)) begins where w_c ends.
template <int Dim>
struct FindLiquidCells {
  static constexpr Doc doc = "(E61) share of a cell that is liquid, not spray";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid, Read<node::Mass> m_i,
                  Read<node::Capacity> capacity, Write<cell::LiquidIndicator> w_c,
                  Write<cell::BulkIndicator> b_c) const;
};

}  // namespace minamo
