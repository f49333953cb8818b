#pragma once
/// \file
/// Which rank has the particles of which block of cells: blocks in the order of Morton's curve (1966), a piece of it
/// for every rank, so that what a rank has lies together.

#include "components/types.hpp"
#include "engine/storage/component.hpp"
#include "systems/grid/cell_blocks.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/grid/splines.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace minamo {

/// What ranks own: so small that pieces of few particles can be as full as others.
template <int Dim>
using RankBlocks = CellBlocks<Dim, 2>;

/// Place of a block on the curve: the bits of its coordinates in turn, x lowest. \pre coordinates below 2^21
template <int Dim>
std::uint64_t morton_key(const Index<Dim>& place) {
  std::uint64_t key = 0;
  for (int bit = 20; bit >= 0; --bit) {
    for (std::size_t d = Dim; d-- > 0;) key = 2 * key + (static_cast<std::uint64_t>(place[d]) >> bit & 1U);
  }
  return key;
}

/// Pieces of the curve, and the rank that has each.
struct RankMap {
  std::vector<std::uint64_t> begin;  ///< of the pieces, the first one at the start of the curve
  std::vector<int> rank;
  double most_imbalance = 1.1;   ///< with so many times the mean on a rank the curve is cut anew
  double largest_imbalance = 1;  ///< that was left so far
  static constexpr ComponentInfo info{"ranks.map", "", "1", Lifetime::cache};

  /// Every rank has the piece of its number.
  void set_in_order(std::vector<std::uint64_t> pieces);
  int owner(std::uint64_t key) const {
    return rank[static_cast<std::size_t>(std::upper_bound(begin.begin(), begin.end(), key) - begin.begin()) - 1];
  }
};

/// The rank that has the block of a point.
template <int Dim>
int rank_at(const RankMap& map, const Grid<Dim>& grid, const Splines<Dim>& splines, const Vec<Dim>& x) {
  const RankBlocks<Dim> blocks(grid, grid.cells);
  return map.owner(morton_key<Dim>(blocks.place_of(cell_around<Dim>(grid, splines, x))));
}

/// A block with particles.
struct BlockLoad {
  std::uint64_t key;
  std::uint64_t particles;
};

/// Cuts the curve so that the fullest rank has as few particles as it can, in pieces of whole blocks (A. Pinar, C.
/// Aykanat, J. Parallel Distrib. Comput. 64 (2004) 974), and the others about as many.
/// \param loads  in the order of the curve; keys may come several times
RankMap cut_curve(std::span<const BlockLoad> loads, int ranks);

/// Particles of the fullest rank.
std::uint64_t fullest(const RankMap& map, std::span<const BlockLoad> loads);

/// Loads of the blocks around points, in the order of the curve.
template <int Dim>
std::vector<BlockLoad> loads_of(const Grid<Dim>& grid, const Splines<Dim>& splines, std::span<const Vec<Dim>> y_p);

}  // namespace minamo
