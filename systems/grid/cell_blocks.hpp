#pragma once
/// \file
/// Blocks of cells. By those of 4^d particles are sorted, and blocks of one colour are worked on side by side; ranks
/// own smaller ones.

#include "components/cells.hpp"
#include "components/grid.hpp"

#include <algorithm>

namespace minamo {

/// The blocks of cells of a grid, x fastest. The last block of an axis takes what is left, so that no block is narrow.
template <int Dim, int Width = OccupiedCells<Dim>::block_width>
class CellBlocks {
 public:
  static constexpr int width = Width;

  /// \param cells  along every axis
  CellBlocks(const Grid<Dim>& grid, const Index<Dim>& cells) : periodic_(grid.periodic), cells_(cells) {
    for (std::size_t d = 0; d < Dim; ++d) blocks_[d] = std::max(1, cells[d] / width);
  }

  std::size_t count() const {
    std::size_t count = 1;
    for (const int blocks : blocks_) count *= static_cast<std::size_t>(blocks);
    return count;
  }
  std::uint32_t block_of(const Index<Dim>& cell) const { return number_of(place_of(cell)); }
  /// Number of the block at a place.
  std::uint32_t number_of(const Index<Dim>& place) const {
    std::size_t block = 0;
    for (std::size_t d = Dim; d-- > 0;)
      block = block * static_cast<std::size_t>(blocks_[d]) + static_cast<std::size_t>(place[d]);
    return static_cast<std::uint32_t>(block);
  }
  /// Number of a cell among those of its block, x fastest.
  std::uint32_t within(const Index<Dim>& cell) const {
    int within = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      const int b = along(d, cell);
      within = within * extent(d, b) + cell[d] - b * width;
    }
    return static_cast<std::uint32_t>(within);
  }
  std::uint32_t cells_in(std::uint32_t block) const {
    const Index<Dim> at = place(block);
    int count = 1;
    for (std::size_t d = 0; d < Dim; ++d) count *= extent(d, at[d]);
    return static_cast<std::uint32_t>(count);
  }
  /// The first and the last of the cells of the block at a place.
  std::array<Index<Dim>, 2> ends(const Index<Dim>& place) const {
    std::array<Index<Dim>, 2> ends;
    for (std::size_t d = 0; d < Dim; ++d) {
      ends[0][d] = place[d] * width;
      ends[1][d] = ends[0][d] + extent(d, place[d]) - 1;
    }
    return ends;
  }
  /// The lowest and the highest corner of its cells. [m]
  std::array<Vec<Dim>, 2> corners(const Grid<Dim>& grid, std::uint32_t block) const {
    const Index<Dim> at = place(block);
    std::array<Vec<Dim>, 2> corner{grid.low, grid.low};
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      corner[0][axis] += grid.spacing * (at[d] * width);
      corner[1][axis] = corner[0][axis] + grid.spacing * extent(d, at[d]);
    }
    return corner;
  }
  /// Calls body(node) for the cells of a block, in the order of their numbers.
  template <class Body>
  void for_each_cell_of(std::uint32_t block, const Body& body) const {
    const Index<Dim> at = place(block);
    Index<Dim> within{};
    for (std::uint32_t left = cells_in(block); left > 0; --left) {
      Index<Dim> node;
      for (std::size_t d = 0; d < Dim; ++d) node[d] = at[d] * width + within[d];
      body(node);
      for (std::size_t d = 0; d < Dim && ++within[d] == extent(d, at[d]) && d + 1 < Dim; ++d) within[d] = 0;
    }
  }
  /// Even and odd places; the last of an odd number around a periodic axis meets an even one and gets a third.
  std::size_t colour(std::uint32_t block) const {
    const Index<Dim> at = place(block);
    std::size_t colour = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      const bool meets_first = periodic_[d] && blocks_[d] % 2 == 1 && at[d] + 1 == blocks_[d];
      colour = 3 * colour + (meets_first ? 2 : static_cast<std::size_t>(at[d] % 2));
    }
    return colour;
  }

  /// Place of the block of a cell among the blocks.
  Index<Dim> place_of(const Index<Dim>& cell) const {
    Index<Dim> place;
    for (std::size_t d = 0; d < Dim; ++d) place[d] = along(d, cell);
    return place;
  }
  /// Calls body(place) for the blocks within so many of a block, itself left out, each once.
  template <class Body>
  void for_each_around(const Index<Dim>& place, int within, const Body& body) const {
    Index<Dim> first;
    Index<Dim> last;
    for (std::size_t d = 0; d < Dim; ++d) {
      // Around a short periodic axis a block would be met from both sides.
      const bool wraps = periodic_[d] && 2 * within + 1 < blocks_[d];
      const bool is_whole = periodic_[d] && !wraps;
      first[d] = wraps ? place[d] - within : is_whole ? 0 : std::max(0, place[d] - within);
      last[d] = wraps ? place[d] + within : is_whole ? blocks_[d] - 1 : std::min(blocks_[d] - 1, place[d] + within);
    }
    Index<Dim> at = first;
    for (;;) {
      Index<Dim> wrapped;
      for (std::size_t d = 0; d < Dim; ++d) wrapped[d] = (at[d] + blocks_[d]) % blocks_[d];
      if (wrapped != place) body(wrapped);
      std::size_t d = 0;
      while (d < Dim && at[d] == last[d]) at[d] = first[d], ++d;
      if (d == Dim) return;
      ++at[d];
    }
  }

 private:
  /// Place along an axis of the block of a cell.
  int along(std::size_t axis, const Index<Dim>& cell) const { return std::min(cell[axis] / width, blocks_[axis] - 1); }
  /// Cells of the blocks at place b of an axis.
  int extent(std::size_t axis, int b) const { return b + 1 < blocks_[axis] ? width : cells_[axis] - b * width; }
  Index<Dim> place(std::uint32_t block) const {
    Index<Dim> place;
    for (std::size_t d = 0; d < Dim; ++d) {
      place[d] = static_cast<int>(block % static_cast<std::uint32_t>(blocks_[d]));
      block /= static_cast<std::uint32_t>(blocks_[d]);
    }
    return place;
  }

  decltype(Grid<Dim>::periodic) periodic_;
  Index<Dim> cells_;
  Index<Dim> blocks_;
};

}  // namespace minamo
