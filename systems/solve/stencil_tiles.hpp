#pragma once
/// \file
/// The rows of the matrix tables along the lines of the grid, four nodes side by side, so that a sum over a stencil is
/// vectorized over nodes: the neighbours of four nodes at one offset lie side by side, too.
///
/// Every node has a lane. A line (all nodes with the same y, z) consists of runs of tiles of four lanes; around every
/// node there is one more tile on each side, as padding. Lanes without a row hold zeros, and so does a run of its own
/// that stands for all that is outside the liquid. Beyond the ends of a periodic x axis there are ghosts of the nodes
/// at the other.

#include "components/grid.hpp"
#include "components/types.hpp"
#include "systems/solve/gmres.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace minamo {

/// What four nodes side by side have.
using Lanes = Eigen::Array<double, 4, 1, Eigen::DontAlign>;
inline Lanes load(const double* from) { return Eigen::Map<const Lanes>(from); }
inline void store(const Lanes& value, double* to) { Eigen::Map<Lanes>{to} = value; }
/// Entry i of four rows of a table.
inline Lanes take(const std::array<const double*, 4>& rows, std::size_t i) {
  return as_vector<Lanes>(Four{rows[0][i], rows[1][i], rows[2][i], rows[3][i]});
}
/// A row for the places without one, as long as any.
inline constexpr std::array<double, 4 * stencil_size<3>> no_row{};

template <int Dim>
class StencilTiles {
 public:
  static constexpr std::size_t width = 4;
  /// Lines that a stencil sees.
  static constexpr std::size_t lines = power(5, Dim - 1);
  struct Tile {
    std::uint32_t lane;                        ///< the first
    std::array<std::uint32_t, lines> beside;   ///< lane with the same x in a line of the stencil, y fastest
    std::array<std::int32_t, width> row;       ///< -1 where there is none
    std::size_t at(std::size_t place) const {  ///< where the neighbour at a place of the stencil begins
      return line(place / 5) + place % 5;
    }
    std::size_t line(std::size_t number) const { return beside[number] - 2; }  ///< where the five of a line begin
  };
  /// \param site  of every node
  /// \param node  of every row, in the order of their sites
  void build(const Grid<Dim>& grid, std::span<const Index<Dim>> site, std::span<const std::uint32_t> node);

  std::size_t rows() const { return lane_.size(); }
  std::size_t lanes() const { return row_.size(); }
  const std::vector<Tile>& tiles() const { return tiles_; }
  std::uint32_t lane(std::size_t row) const { return lane_[row]; }
  /// The row of a lane, of a periodic ghost too; -1 if there is none.
  std::int32_t row(std::size_t lane) const { return row_[lane]; }
  const Tile& tile(std::size_t row) const { return tiles_[tile_of_row_[row]]; }
  /// Calls body(place in the stencil, row) for the neighbours of a row that have one.
  template <class Body>
  void for_each_neighbour(std::size_t row, const Body& body) const {
    const Tile& of_row = tile(row);
    const std::size_t i = lane_[row] % width;
    for (std::size_t line = 0; line < lines; ++line) {
      if (is_outside(of_row.beside[line])) continue;
      const std::int32_t* there = row_.data() + of_row.beside[line] + i - 2;
      for (std::size_t x = 0; x < 5; ++x) {
        if (there[x] >= 0) body(5 * line + x, static_cast<std::size_t>(there[x]));
      }
    }
  }
  /// Whether a tile has all rows and they all their neighbours.
  bool is_whole(const Tile& tile) const;
  /// Gives periodic ghosts what their nodes have.
  void fill_ghosts(double* of_lane) const {
    for_each_ghost([&](std::uint32_t from, std::uint32_t to) { of_lane[to] = of_lane[from]; });
  }
  /// Whether a lane beside a tile stands for what is beyond the water.
  static constexpr bool is_outside(std::uint32_t beside) { return beside == width; }
  /// Calls body(lane of the node, lane of its periodic ghost).
  template <class Body>
  void for_each_ghost(const Body& body) const {
    for (const auto& [from, to] : ghosts_) body(from, to);
  }
  /// Calls body(lane) for the first lanes of tiles without a row.
  template <class Body>
  void for_each_padding(const Body& body) const {
    for (const std::uint32_t lane : padding_) body(lane);
  }

 private:
  struct Line {
    std::size_t number;  ///< y + count of y times z
    std::uint32_t first_row;
    std::uint32_t first_run;
  };
  /// Slots of one line that follow one another.
  struct Run {
    std::uint32_t begin;
    std::uint32_t length;
  };
  void find_runs(const Grid<Dim>& grid, std::span<const Index<Dim>> site, std::span<const std::uint32_t> node);
  void find_tiles(const Grid<Dim>& grid);
  void cover(int tile);
  std::array<std::int32_t, lines> lines_around(const Grid<Dim>& grid, std::size_t number) const;
  std::uint32_t lane_in_line(std::int32_t line, int tile) const;

  std::vector<Line> lines_;
  std::vector<Run> runs_;
  std::vector<int> first_tile_;  ///< of every run, counted along x
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> lane_;
  std::vector<std::uint32_t> tile_of_row_;
  std::vector<std::int32_t> row_;
  std::vector<std::uint32_t> padding_;
  std::vector<std::array<std::uint32_t, 2>> ghosts_;
};

/// `entries` numbers per lane. Those of a tile lie together, its four lanes side by side: a product streams through
/// memory.
template <int Dim>
class TileEntries {
 public:
  static constexpr std::size_t width = StencilTiles<Dim>::width;

  void resize(const StencilTiles<Dim>& tiles, std::size_t entries) {
    entries_ = entries;
    values_.resize(entries * tiles.lanes());
  }
  /// Entry 0 of a lane; entry e stands e * width further, those of the tiles beside it to_next() further or before.
  double* at(std::size_t lane) { return values_.data() + place(lane); }
  const double* at(std::size_t lane) const { return values_.data() + place(lane); }
  std::size_t to_next() const { return width * entries_; }
  /// Calls body(place in the stencil, row of the neighbour, entry) for the neighbours of a row, whose entries are every
  /// `step`-th from the first.
  template <class Body>
  void for_each_neighbour(const StencilTiles<Dim>& tiles, std::size_t row, std::size_t first, std::size_t step,
                          const Body& body) const {
    const double* entry = at(tiles.lane(row)) + first * width;
    tiles.for_each_neighbour(row, [&](std::size_t k, std::size_t other) { body(k, other, entry[k * step * width]); });
  }

 private:
  std::size_t place(std::size_t lane) const { return lane / width * to_next() + lane % width; }
  std::size_t entries_ = 0;
  Values values_;
};

/// An entry of the lanes from two before a tile to two behind it, four side by side.
/// \param entry    of the tile
/// \param to_next  TileEntries::to_next()
inline std::array<Lanes, 5> around(const double* entry, std::size_t to_next) {
  const auto four = [](const double* from) {
    Four value;
    std::memcpy(&value, from, sizeof value);
    return value;
  };
  const Four before = four(entry - to_next);
  const Four own = four(entry);
  const Four behind = four(entry + to_next);
  return {as_vector<Lanes>(__builtin_shufflevector(before, own, 2, 3, 4, 5)),
          as_vector<Lanes>(__builtin_shufflevector(before, own, 3, 4, 5, 6)), as_vector<Lanes>(own),
          as_vector<Lanes>(__builtin_shufflevector(own, behind, 1, 2, 3, 4)),
          as_vector<Lanes>(__builtin_shufflevector(own, behind, 2, 3, 4, 5))};
}

/// Nodes of a tile, in the plane and in space.
inline constexpr std::size_t tile_width = StencilTiles<2>::width;
/// Tiles that a task of a parallel loop takes.
inline constexpr std::size_t tiles_per_task = 32;

}  // namespace minamo
