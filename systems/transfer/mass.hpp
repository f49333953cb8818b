#pragma once
/// \file
/// Nodal mass.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E3)  m_I = sum_p S_Ip m_p.
template <int Dim>
struct P2GMass {
  static constexpr Doc doc = "(E3) m_I";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<particle::Mass> m_p, Write<node::Mass> m_i) const;
};

}  // namespace minamo
