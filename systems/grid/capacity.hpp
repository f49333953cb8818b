#pragma once
/// \file
/// Capacity of the nodes: the volume that each can hold. What a node holds over its capacity is its fill fraction.

#include "components/advected_node.hpp"
#include "components/node.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E39)  V_I of the nodes of the step.
template <int Dim>
struct FindCapacity {
  static constexpr Doc doc = "(E39) V_I";
  void operator()(Read<Grid<Dim>> grid, Read<node::Site<Dim>> sites, Write<node::Capacity> capacity) const;
};

/// (E39)  V_I of the nodes that particles touch where the step has moved them.
template <int Dim>
struct FindAdvectedCapacity {
  static constexpr Doc doc = "(E39) V_I at the end of the step";
  void operator()(Read<Grid<Dim>> grid, Read<advected_node::Site<Dim>> sites,
                  Write<advected_node::Capacity> capacity) const;
};

}  // namespace minamo
