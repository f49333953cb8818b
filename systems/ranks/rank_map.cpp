#include "systems/ranks/rank_map.hpp"

#include "systems/grid/site_support.hpp"

#include <algorithm>
#include <numeric>

namespace minamo {

void RankMap::set_in_order(std::vector<std::uint64_t> pieces) {
  begin = std::move(pieces);
  rank.resize(begin.size());
  std::iota(rank.begin(), rank.end(), 0);
}

namespace {

/// Cuts blocks one after the other into pieces, none of which may have more than so many particles.
class CutWithin {
 public:
  CutWithin(std::span<const BlockLoad> blocks, std::uint64_t capacity)
      : blocks_(blocks), end_(blocks.size()), pieces_(blocks.size() + 1, 0) {
    std::uint64_t load = 0;
    for (std::size_t begin = blocks.size(), end = begin; begin-- > 0;) {
      load += blocks[begin].particles;
      while (load > capacity) load -= blocks[--end].particles;
      end_[begin] = end;
      pieces_[begin] = 1 + pieces_[end];
    }
  }
  /// How many at least are behind a block, itself among them.
  std::size_t pieces(std::size_t begin) const { return pieces_[begin]; }
  /// Where a piece ends that has about its share of what is left, if so many more can follow.
  std::size_t end_of_share(std::size_t begin, std::uint64_t left, std::size_t more) const {
    std::size_t end = begin;
    std::uint64_t load = 0;
    while (end < blocks_.size() && end < end_[begin]) {
      const std::uint64_t with_next = load + blocks_[end].particles;
      if (pieces_[end] <= more && (load + with_next) * (more + 1) > 2 * left) break;
      load = with_next;
      ++end;
    }
    return end;
  }

 private:
  std::span<const BlockLoad> blocks_;
  std::vector<std::size_t> end_;     ///< of the longest piece from a block on
  std::vector<std::size_t> pieces_;  ///< from a block on
};

/// Loads with the same key as one.
std::vector<BlockLoad> by_block(std::span<const BlockLoad> loads) {
  std::vector<BlockLoad> blocks;
  for (const BlockLoad& load : loads) {
    if (blocks.empty() || blocks.back().key != load.key) blocks.push_back({load.key, 0});
    blocks.back().particles += load.particles;
  }
  return blocks;
}

/// The least that the fullest piece can have.
std::uint64_t least_capacity(std::span<const BlockLoad> blocks, std::size_t ranks) {
  std::uint64_t low = 0;
  std::uint64_t all = 0;
  for (const BlockLoad& block : blocks) {
    low = std::max(low, block.particles);
    all += block.particles;
  }
  for (std::uint64_t high = all; low < high;) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (CutWithin(blocks, middle).pieces(0) <= ranks) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace

RankMap cut_curve(std::span<const BlockLoad> loads, int ranks) {
  const std::vector<BlockLoad> blocks = by_block(loads);
  const auto count = static_cast<std::size_t>(ranks);
  const CutWithin cut(blocks, least_capacity(blocks, count));
  std::uint64_t left = 0;
  for (const BlockLoad& block : blocks) left += block.particles;
  std::vector<std::uint64_t> begin{0};
  for (std::size_t at = 0; begin.size() < count;) {
    const std::size_t end = cut.end_of_share(at, left, count - begin.size());
    if (end == blocks.size()) break;
    for (; at < end; ++at) left -= blocks[at].particles;
    begin.push_back(blocks[at].key);
  }
  // More ranks than blocks: the last ones have nothing.
  begin.resize(count, std::uint64_t{1} << 63);
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
  const RankBlocks<Dim> blocks(grid, grid.cells);
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
