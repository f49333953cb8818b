#include "systems/ranks/ghost_cells.hpp"

#include <map>
#include <unordered_map>

namespace minamo {

namespace {

template <class T>
void sort_once(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// What another rank hears of a cell.
template <int Dim>
struct CellOfRank {
  Index<Dim> at;
  std::uint64_t hidden;
};

/// Which ranks own parts of blocks of 4^d cells.
template <int Dim>
class OwnersOfBlocks {
 public:
  OwnersOfBlocks(const Grid<Dim>& grid, const CellBlocks<Dim>& blocks, const RankMap& map)
      : blocks_(blocks), parts_(grid, grid.cells), map_(map) {}

  const std::vector<int>& of(const Index<Dim>& place) {
    const auto [found, is_new] = of_block_.try_emplace(blocks_.number_of(place));
    std::vector<int>& owners = found->second;
    if (!is_new) return owners;
    const auto ends = blocks_.ends(place);
    const Index<Dim> first = parts_.place_of(ends[0]);
    const Index<Dim> last = parts_.place_of(ends[1]);
    Index<Dim> part = first;
    for (std::size_t d = 0; d < Dim;) {
      owners.push_back(map_.owner(morton_key<Dim>(part)));
      for (d = 0; d < Dim && part[d] == last[d]; ++d) part[d] = first[d];
      if (d < Dim) ++part[d];
    }
    sort_once(owners);
    return owners;
  }

 private:
  const CellBlocks<Dim>& blocks_;
  RankBlocks<Dim> parts_;
  const RankMap& map_;
  std::unordered_map<std::uint32_t, std::vector<int>> of_block_;
};

}  // namespace

template <int Dim>
void FindGhostCells<Dim>::operator()(Read<Ranks> ranks, Read<RankMap> map, Read<ReachOnRanks> reach,
                                     Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                     Optional<Read<HiddenSites>> hidden, Optional<Read<BlocksNearBodies>> near,
                                     Write<GhostCells<Dim>> ghosts) const {
  const CellBlocks<Dim> blocks(*grid, grid->cells);
  const int layers = layers_of_ghosts(splines->degree, reach->sites);
  const auto has_body_near = [&](const Index<Dim>& place) {
    return near && near->has_near[blocks.number_of(place)] != 0;
  };
  auto& covered = ghosts->covered;
  covered.clear();
  // Cells of a block come one after the other.
  std::map<int, std::vector<CellOfRank<Dim>>> to;
  std::vector<int> around;
  OwnersOfBlocks<Dim> owners_of(*grid, blocks, *map);
  for (std::size_t c = 0; c < cells->cells.size(); ++c) {
    const Index<Dim>& cell = cells->cells[c].node;
    const Index<Dim> place = blocks.place_of(cell);
    if (c == 0 || place != blocks.place_of(cells->cells[c - 1].node)) {
      around.clear();
      const auto cover = [&](const Index<Dim>& other) {
        covered.push_back(morton_key<Dim>(other));
        const std::vector<int>& owners = owners_of.of(other);
        around.insert(around.end(), owners.begin(), owners.end());
      };
      cover(place);
      blocks.for_each_around(place, layers, cover);
      if (has_body_near(place)) {
        blocks.for_each_around(place, layers_of_ghosts(splines->degree, near->sites), [&](const Index<Dim>& other) {
          if (has_body_near(other)) cover(other);
        });
      }
      sort_once(around);
    }
    for (const int rank : around) {
      if (rank != (*ranks)->rank()) to[rank].push_back({cell, hidden ? hidden->of_cell[c] : 0});
    }
  }
  sort_once(covered);

  std::vector<Communicator::Message> sent;
  for (const auto& [rank, of_rank] : to) sent.push_back({rank, to_bytes(std::span<const CellOfRank<Dim>>(of_rank))});
  ghosts->cells.clear();
  for (const auto& message : (*ranks)->exchange(sent)) {
    for (const auto& [at, hidden_there] : from_bytes<CellOfRank<Dim>>(message.bytes)) {
      if (ghosts->covers(morton_key<Dim>(blocks.place_of(at))))
        ghosts->cells.push_back({at, message.rank, hidden_there});
    }
  }
}

template struct FindGhostCells<2>;
template struct FindGhostCells<3>;

}  // namespace minamo
