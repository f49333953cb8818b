#pragma once
/// \file
/// Which nodes of the grid have a row in the node tables.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// Work space of the numbering, kept so that a step does not allocate.
struct NumberingBuffer {
  std::vector<std::optional<std::uint32_t>> from;  ///< which row a row was before
  static constexpr ComponentInfo info{"node.numbering_buffer", "", "1", Lifetime::cache};
};

/// Gives the nodes of occupied dual cells rows, in the order of their sites. What outlives a step moves along; nodes
/// that had no row start from zero.
template <int Dim>
struct NumberNodes {
  static constexpr Doc doc = "number the nodes of occupied dual cells";
  void operator()(Read<Grid<Dim>> grid, Read<Walls<Dim>> walls, Resize<Nodes> nodes, Update<OccupiedCells<Dim>> cells,
                  Update<NodeIndex<Dim>> rows, Update<node::Site<Dim>> sites, Write<node::Constraint> constraint,
                  Update<NumberingBuffer> buffer) const;
};

}  // namespace minamo
