#pragma once
/// \file
/// The neighbours of active nodes, looked up once per step for all that go over them.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

template <int Dim>
struct FindNeighbours {
  static constexpr Doc doc = "nodes that can share a particle with an active node";
  void operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows, Read<node::Site<Dim>> sites, Read<matrix::Node> node,
                  Write<matrix::Neighbour<Dim>> neighbour) const;
};

/// Calls body(place, neighbour) for the neighbours of a row, among them ballistic nodes and the node itself.
template <int Dim, class Body>
void for_each_neighbour(const typename matrix::Neighbour<Dim>::value_type& of_row, const Body& body) {
  for (std::size_t k = 0; k < of_row.size(); ++k) {
    if (of_row[k] != matrix::Neighbour<Dim>::none) body(k, static_cast<std::uint32_t>(of_row[k]));
  }
}

}  // namespace minamo
