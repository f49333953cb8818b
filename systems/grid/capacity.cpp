#include "systems/grid/capacity.hpp"

#include "systems/grid/node_volume.hpp"

namespace minamo {

template <int Dim>
void FindCapacity<Dim>::operator()(Read<Grid<Dim>> grid, Read<node::Site<Dim>> sites,
                                   Write<node::Capacity> capacity) const {
  for_each_row(sites.size(), [&](std::size_t i) { capacity[i] = full_volume<Dim>(*grid, sites[i]); });
}

template <int Dim>
void FindAdvectedCapacity<Dim>::operator()(Read<Grid<Dim>> grid, Read<advected_node::Site<Dim>> sites,
                                           Write<advected_node::Capacity> capacity) const {
  for_each_row(sites.size(), [&](std::size_t i) { capacity[i] = full_volume<Dim>(*grid, sites[i]); });
}

template struct FindCapacity<2>;
template struct FindCapacity<3>;
template struct FindAdvectedCapacity<2>;
template struct FindAdvectedCapacity<3>;

}  // namespace minamo
