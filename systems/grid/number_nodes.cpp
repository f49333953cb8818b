#include "systems/grid/number_nodes.hpp"

#include "systems/grid/point_locator.hpp"

namespace minamo {

namespace {

/// The components that the walls hold at a site.
template <int Dim>
std::uint8_t held_at(const Grid<Dim>& grid, const Walls<Dim>& walls, const Index<Dim>& site) {
  std::uint8_t held = 0;
  for (std::size_t d = 0; d < Dim; ++d) {
    if (site[d] == 0) held |= walls.held[d][0];
    if (site[d] == grid.cells[d]) held |= walls.held[d][1];
  }
  return held;
}

/// Tells every cell the rows of its nodes.
template <int Dim>
void look_up(const Grid<Dim>& grid, const NodeIndex<Dim>& rows, OccupiedCells<Dim>& cells) {
  constexpr std::size_t cells_per_task = 64;
  const auto of_cell = [&](std::size_t c) {
    auto& cell = cells.cells[c];
    typename SiteRows<Dim>::Finder find(rows);
    for_each_address<Dim>(grid, rows, SupportBox<Dim>(grid, cell.node),
                          [&](std::size_t k, const auto& address) { cell.rows[k] = *find(address); });
  };
  for_each_row(cells.cells.size(), of_cell, cells_per_task);
}

}  // namespace

template <int Dim>
void NumberNodes<Dim>::operator()(Read<Grid<Dim>> grid, Read<Walls<Dim>> walls, Resize<Nodes> nodes,
                                  Update<OccupiedCells<Dim>> cells, Update<NodeIndex<Dim>> rows,
                                  Update<node::Site<Dim>> sites, Write<node::Constraint> constraint,
                                  Update<NumberingBuffer> buffer) const {
  rows->start(*grid);
  typename SiteRows<Dim>::Adder add(*rows);
  for (const auto& cell : cells->cells) {
    for_each_address<Dim>(*grid, *rows, SupportBox<Dim>(*grid, cell.node),
                          [&](std::size_t, const auto& address) { add(address); });
  }
  buffer->from.resize(rows->number_rows());
  rows->find_former_rows(sites.span(), buffer->from);
  nodes.renumber(buffer->from);
  rows->for_each([&](const Index<Dim>& site, std::uint32_t i) {
    sites[i] = site;
    constraint[i] = held_at<Dim>(*grid, *walls, site);
  });
  look_up<Dim>(*grid, *rows, *cells);
}

template struct NumberNodes<2>;
template struct NumberNodes<3>;

}  // namespace minamo
