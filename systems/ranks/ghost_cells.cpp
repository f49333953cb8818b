#include "systems/ranks/ghost_cells.hpp"

#include <map>

namespace minamo {

namespace {

void sort_once(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

}  // namespace

template <int Dim>
void FindGhostCells<Dim>::operator()(Read<Ranks> ranks, Read<RankMap> map, Read<Grid<Dim>> grid,
                                     Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                     Write<GhostCells<Dim>> ghosts) const {
  const CellBlocks<Dim> blocks(*grid, grid->cells);
  const int layers = layers_of_ghosts(splines->degree);
  auto& covered = ghosts->covered;
  covered.clear();
  // Cells of a block come one after the other.
  std::map<int, std::vector<Index<Dim>>> to;
  std::vector<int> around;
  for (std::size_t c = 0; c < cells->cells.size(); ++c) {
    const Index<Dim>& cell = cells->cells[c].node;
    const Index<Dim> place = blocks.place_of(cell);
    if (c == 0 || place != blocks.place_of(cells->cells[c - 1].node)) {
      covered.push_back(morton_key<Dim>(place));
      around.clear();
      blocks.for_each_around(place, layers, [&](const Index<Dim>& other) {
        covered.push_back(morton_key<Dim>(other));
        around.push_back(map->owner(covered.back()));
      });
      std::sort(around.begin(), around.end());
      around.erase(std::unique(around.begin(), around.end()), around.end());
    }
    for (const int rank : around) {
      if (rank != (*ranks)->rank()) to[rank].push_back(cell);
    }
  }
  sort_once(covered);

  std::vector<Communicator::Message> sent;
  for (const auto& [rank, of_rank] : to) sent.push_back({rank, to_bytes(std::span<const Index<Dim>>(of_rank))});
  ghosts->cells.clear();
  for (const auto& message : (*ranks)->exchange(sent)) {
    for (const Index<Dim>& cell : from_bytes<Index<Dim>>(message.bytes)) {
      if (ghosts->covers(morton_key<Dim>(blocks.place_of(cell)))) ghosts->cells.push_back({cell, message.rank});
    }
  }
}

template struct FindGhostCells<2>;
template struct FindGhostCells<3>;

}  // namespace minamo
