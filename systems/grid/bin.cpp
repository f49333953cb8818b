#include "systems/grid/bin.hpp"

#include "systems/grid/cell_blocks.hpp"
#include "systems/grid/site_support.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Numbers the cells of the blocks with particles, block by block, and tells every particle that of its cell.
/// \return how many cells these are
template <int Dim, class CellOf>
std::size_t number_cells(const CellBlocks<Dim>& blocks, std::span<const Vec<Dim>> y_p, const CellOf& cell_of,
                         BinBuffer& buffer) {
  auto& number = buffer.number;
  number.resize(y_p.size());
  buffer.within.resize(y_p.size());
  for_each_row(y_p.size(), [&](std::size_t p) {
    const Index<Dim> cell = cell_of(y_p[p]);
    number[p] = blocks.block_of(cell);
    buffer.within[p] = static_cast<std::uint16_t>(blocks.within(cell));
  });
  buffer.blocks.start(blocks.count());
  for (const std::uint32_t block : number) buffer.blocks.number(block);
  buffer.blocks.sort();
  buffer.first_of_block.resize(buffer.blocks.size());
  std::uint32_t cells = 0;
  for (const std::uint32_t block : buffer.blocks.used()) {
    buffer.first_of_block[*buffer.blocks.find(block)] = cells;
    cells += blocks.cells_in(block);
  }
  for_each_row(y_p.size(), [&](std::size_t p) {
    number[p] = buffer.first_of_block[*buffer.blocks.find(number[p])] + buffer.within[p];
  });
  return cells;
}

/// Lists the cells and blocks that hold particles.
template <int Dim>
void list_occupied(const CellBlocks<Dim>& blocks, const BinBuffer& buffer, OccupiedCells<Dim>& occupied) {
  occupied.cells.clear();
  for (auto& of_colour : occupied.blocks) of_colour.clear();
  std::size_t number = 0;
  for (const std::uint32_t block : buffer.blocks.used()) {
    const auto begin = static_cast<std::uint32_t>(occupied.cells.size());
    blocks.for_each_cell_of(block, [&](const Index<Dim>& node) {
      const std::uint32_t first = buffer.first[number++];
      if (first < buffer.first[number]) occupied.cells.push_back({node, first, buffer.first[number], {}});
    });
    occupied.blocks[blocks.colour(block)].push_back({begin, static_cast<std::uint32_t>(occupied.cells.size())});
  }
}

/// Sorts particles by the cell of y_p, cell_of(y_p).
template <int Dim, class CellOf>
void sort_particles(const Grid<Dim>& grid, const Index<Dim>& cell_counts, const CellOf& cell_of,
                    std::span<const Vec<Dim>> y_p, Resize<Particles> particles, OccupiedCells<Dim>& cells,
                    Resize<Cells> rows, BinBuffer& buffer) {
  const CellBlocks<Dim> blocks(grid, cell_counts);
  const std::size_t cell_count = number_cells<Dim>(blocks, y_p, cell_of, buffer);
  auto& [used, first_of_block, number, within, first, place] = buffer;

  // Counting sort: first[c] becomes the place of the first particle of cell c.
  first.assign(cell_count + 1, 0);
  for (const std::uint32_t c : number) ++first[c + 1];
  for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
  list_occupied<Dim>(blocks, buffer, cells);
  rows.resize(cells.cells.size());
  if (std::is_sorted(number.begin(), number.end())) return;
  place.resize(number.size());
  for (std::size_t p = 0; p < number.size(); ++p) place[first[number[p]]++] = static_cast<std::uint32_t>(p);
  particles.reorder(place);
}

/// dual_cell(), and where two meet to rounding, as where particles are in the middles of cells, the one nearer to the
/// middle of the box: in the mirror it is the image of that.
template <int Dim>
Index<Dim> inner_dual_cell(const Grid<Dim>& grid, Vec<Dim> y) {
  const double meet = 1e-9 * grid.spacing;
  for (int d = 0; d < Dim; ++d) y[d] += std::copysign(meet, 0.5 * (grid.low[d] + grid.high[d]) - y[d]);
  return dual_cell<Dim>(grid, y);
}

}  // namespace

template <int Dim>
void Bin<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::QuadraturePosition<Dim>> y_p,
                          Resize<Particles> particles, Write<OccupiedCells<Dim>> cells, Resize<Cells> rows,
                          Update<BinBuffer> buffer) const {
  Index<Dim> counts;
  for (int d = 0; d < Dim; ++d) counts[static_cast<std::size_t>(d)] = grid->nodes(d);
  const auto cell_of = [&](const Vec<Dim>& y) { return inner_dual_cell<Dim>(*grid, y); };
  sort_particles<Dim>(*grid, counts, cell_of, y_p.span(), particles, *cells, rows, *buffer);
}

template <int Dim>
void BinByCell<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                Read<particle::QuadraturePosition<Dim>> y_p, Resize<Particles> particles,
                                Write<GridCells<Dim>> cells, Resize<Cells> rows, Update<BinBuffer> buffer) const {
  const auto cell_of = [&](const Vec<Dim>& y) { return cell_around<Dim>(*grid, *splines, y); };
  sort_particles<Dim>(*grid, grid->cells, cell_of, y_p.span(), particles, *cells, rows, *buffer);
}

template struct Bin<2>;
template struct Bin<3>;
template struct BinByCell<2>;
template struct BinByCell<3>;

}  // namespace minamo
