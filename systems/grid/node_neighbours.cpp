#include "systems/grid/node_neighbours.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/node_stencil.hpp"

namespace minamo {

template <int Dim>
void FindNeighbours<Dim>::operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows, Read<node::Site<Dim>> sites,
                                     Read<matrix::Node> node, Write<matrix::Neighbour<Dim>> neighbour) const {
  constexpr std::size_t rows_per_task = 256;
  const Stencil<Dim> stencil(*grid, *rows, sites.span());
  const auto of_row = [&](std::size_t r) {
    neighbour[r].fill(matrix::Neighbour<Dim>::none);
    stencil.for_each_neighbour(node[r],
                               [&](std::size_t k, std::uint32_t j) { neighbour[r][k] = static_cast<std::int32_t>(j); });
  };
  for_each_row(node.size(), of_row, rows_per_task);
}

template struct FindNeighbours<2>;
template struct FindNeighbours<3>;

}  // namespace minamo
