#include "systems/grid/capacity.hpp"

#include "systems/grid/node_volume.hpp"

namespace minamo {

template <int Dim>
void FindCapacity<Dim>::operator()(Read<Grid<Dim>> grid, Read<node::Site<Dim>> sites,
                                   Write<node::Capacity> capacity) const {
  for_each_row(sites.size(), [&](std::size_t i) { capacity[i] = full_volume<Dim>(*grid, sites[i]); });
}

template <int Dim>
void FindEndCapacity<Dim>::operator()(Read<Grid<Dim>> grid, Read<end_node::Site<Dim>> sites,
                                      Write<end_node::Capacity> capacity) const {
  for_each_row(sites.size(), [&](std::size_t i) { capacity[i] = full_volume<Dim>(*grid, sites[i]); });
}

template struct FindCapacity<2>;
template struct FindCapacity<3>;
template struct FindEndCapacity<2>;
template struct FindEndCapacity<3>;

}  // namespace minamo
