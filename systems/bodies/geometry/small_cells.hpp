#pragma once
/// \file
/// A lattice of small cells, several along a cell of the grid, of which blocks of the size of one are kept where they
/// are needed.

#include "systems/grid/site_places.hpp"

#include <optional>

namespace minamo {

/// Small cells by number, those of a block one after the other, and where they are.
template <int Dim>
class SmallCells {
 public:
  static constexpr std::int32_t none = -1;
  /// Small cells per cell of the grid and direction.
  static constexpr int fineness = Dim == 2 ? 8 : 4;
  static constexpr std::size_t per_block = power(fineness, Dim);

  /// \param region   that blocks are to cover [m]
  /// \param spacing  of the grid [m]
  SmallCells(const Bounds<Dim>& region, double spacing);

  std::size_t blocks() const { return rows_in<Dim>(blocks_); }
  /// Keeps the blocks within some blocks of those that are marked.
  void keep(const std::vector<std::uint8_t>& marked, int within);
  std::size_t kept() const { return kept_.size(); }
  /// Of the kept blocks, one after the other.
  std::size_t size() const { return kept_.size() * per_block; }
  double spacing() const { return spacing_; }
  /// Side of a small cell. [m]
  double side() const { return spacing_ / fineness; }

  Vec<Dim> middle_of_block(std::size_t block) const;
  /// Of a small cell by its number in a block, or among all.
  Vec<Dim> middle_within(std::size_t block, std::size_t within) const;
  Vec<Dim> middle(std::size_t small) const { return middle_within(kept_[small / per_block], small % per_block); }
  /// The small cell at a place, and the place of a point or of a small cell, by small cells along every axis.
  std::int32_t at(const Index<Dim>& place) const;
  std::int32_t at(const Vec<Dim>& x) const;
  std::optional<Index<Dim>> place_of(const Vec<Dim>& x) const;
  Index<Dim> place_of(std::int32_t small) const;
  /// \param side  2 d below and 2 d + 1 above along axis d
  std::int32_t neighbour(std::size_t small, std::size_t side) const;
  /// Those of a window of so many along every axis, x fastest.
  std::vector<std::int32_t> window(const Index<Dim>& low, int across) const;
  /// Kept blocks within so many of marked ones.
  std::vector<std::uint8_t> blocks_near(const std::vector<std::uint8_t>& marked, int within) const;
  /// Calls use(first small cell) for the kept blocks from one to another one until it returns true.
  /// \return whether it has
  template <class Use>
  bool any_block(const Index<Dim>& low, const Index<Dim>& high, const Use& use) const;
  /// The blocks within a distance of a point, and within so many small cells of a place: the lowest and the highest.
  std::array<Index<Dim>, 2> blocks_around(const Vec<Dim>& x, double within) const;
  std::array<Index<Dim>, 2> blocks_around(const Index<Dim>& place, int within) const;

 private:
  /// Of the blocks: half a small cell below that of the region, so that points of the grid are in the middle of small
  /// cells, and rounding does not say in which. [m]
  Vec<Dim> low_;
  double spacing_;
  Index<Dim> blocks_{};              ///< of the size of a cell, along every axis
  std::vector<std::int32_t> first_;  ///< small cell of every block, or none
  std::vector<std::uint32_t> kept_;  ///< the blocks that have any
  std::vector<std::array<std::int32_t, 2 * static_cast<std::size_t>(Dim)>> next_;  ///< first_ of blocks next to them
};

template <int Dim>
template <class Use>
bool SmallCells<Dim>::any_block(const Index<Dim>& low, const Index<Dim>& high, const Use& use) const {
  Index<Dim> sides;
  for (std::size_t d = 0; d < Dim; ++d) {
    sides[d] = high[d] - low[d] + 1;
    if (sides[d] <= 0) return false;
  }
  for (std::size_t k = 0; k < rows_in<Dim>(sides); ++k) {
    Index<Dim> block = index_in<Dim>(sides, k);
    for (std::size_t d = 0; d < Dim; ++d) block[d] += low[d];
    const std::int32_t first = first_[row_in<Dim>(blocks_, block)];
    if (first != none && use(first)) return true;
  }
  return false;
}

}  // namespace minamo
