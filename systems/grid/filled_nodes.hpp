#pragma once
/// \file
/// Where the liquid fills the space around a node, so that integrals need no particles.

#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// theta of (E67) from the least fill fraction around: 0 up to 0.9, 1 from 0.97 on.
double filled_indicator(double least_fill);

/// (E67)  phi_I = m_I/(rho V_I), V_I (E39), 0 if no particle is in the dual cell of I;
/// theta_I = min(1, max(0, (f_I - 0.9)/0.07)), f_I the least phi_J of the nodes of the dual cell of I.
template <int Dim>
struct FindFilledNodes {
  static constexpr Doc doc = "(E67) filled nodes";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid, Read<node::Mass> m_i,
                  Read<node::Capacity> capacity, Write<node::FillFraction> phi_i,
                  Write<node::FilledIndicator> theta_i) const;
};

}  // namespace minamo
