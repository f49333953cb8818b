#include "systems/ranks/rank_map.hpp"

#include "systems/grid/site_support.hpp"

#include <numeric>

namespace minamo {

void RankMap::set_in_order(std::vector<std::uint64_t> pieces) {
  begin = std::move(pieces);
  rank.resize(begin.size());
  std::iota(rank.begin(), rank.end(), 0);
}

RankMap cut_curve(std::span<const BlockLoad> loads, int ranks) {
  std::uint64_t all = 0;
  for (const BlockLoad& load : loads) all += load.particles;
  std::vector<std::uint64_t> begin{0};
  std::uint64_t before = 0;
  for (const BlockLoad& load : loads) {
    // A piece begins where what lies before is nearest to its share.
    while (static_cast<int>(begin.size()) < ranks &&
           2 * before + load.particles > 2 * all * begin.size() / static_cast<std::uint64_t>(ranks)) {
      begin.push_back(load.key);
    }
    before += load.particles;
  }
  // More ranks than blocks: the last ones have nothing.
  begin.resize(static_cast<std::size_t>(ranks), std::uint64_t{1} << 63);
  RankMap map;
  map.set_in_order(std::move(begin));
  return map;
}

std::uint64_t fullest(const RankMap& map, std::span<const BlockLoad> loads) {
  std::vector<std::uint64_t> of_rank(map.rank.size());
  for (const BlockLoad& load : loads) of_rank[static_cast<std::size_t>(map.owner(load.key))] += load.particles;
  return *std::max_element(of_rank.begin(), of_rank.end());
}

template <int Dim>
std::vector<BlockLoad> loads_of(const Grid<Dim>& grid, const Splines<Dim>& splines, std::span<const Vec<Dim>> y_p) {
  const CellBlocks<Dim> blocks(grid, grid.cells);
  std::vector<std::uint64_t> keys;
  keys.reserve(y_p.size());
  for (const Vec<Dim>& y : y_p) keys.push_back(morton_key<Dim>(blocks.place_of(cell_around<Dim>(grid, splines, y))));
  std::sort(keys.begin(), keys.end());
  std::vector<BlockLoad> loads;
  for (const std::uint64_t key : keys) {
    if (loads.empty() || loads.back().key != key) loads.push_back({key, 0});
    ++loads.back().particles;
  }
  return loads;
}

template std::vector<BlockLoad> loads_of<2>(const Grid<2>&, const Splines<2>&, std::span<const Vec<2>>);
template std::vector<BlockLoad> loads_of<3>(const Grid<3>&, const Splines<3>&, std::span<const Vec<3>>);

}  // namespace minamo
