#pragma once
/// \file
/// The Cartesian grid: nodes at low + h (i, j, k), i = 0 .. cells. Around every node lies its dual cell, the points
/// nearest to it, cut in half at walls. Particles of one dual cell share their 3^d nodes.
/// Along a periodic axis the node at the high end is the one at the low end, and the box has no walls there.

#include "components/types.hpp"
#include "engine/storage/component.hpp"

namespace minamo {

/// The box and its cells. Read it as `Read<Grid<Dim>> grid`.
template <int Dim>
struct Grid {
  Vec<Dim> low = Vec<Dim>::Zero();   ///< corner of the box [m]
  Vec<Dim> high = Vec<Dim>::Zero();  ///< opposite corner [m]
  double spacing = 0;                ///< h, the same in all directions [m]
  Index<Dim> cells{};                ///< per direction, at least 3; at least 5 along a periodic axis
  std::array<bool, static_cast<std::size_t>(Dim)> periodic{};  ///< per axis
  static constexpr ComponentInfo info{"grid", "h", "m", Lifetime::constant};

  /// Nodes along an axis.
  int nodes(int axis) const {
    const auto d = static_cast<std::size_t>(axis);
    return cells[d] + (periodic[d] ? 0 : 1);
  }
  /// The node itself, or the one that it stands for beyond the end of a periodic axis.
  int wrapped(int axis, int node) const {
    if (!periodic[static_cast<std::size_t>(axis)]) return node;
    const int count = nodes(axis);
    return node < 0 ? node + count : node >= count ? node - count : node;
  }
  /// Nodes of the box.
  std::size_t node_count() const {
    std::size_t count = 1;
    for (int d = 0; d < Dim; ++d) count *= static_cast<std::size_t>(nodes(d));
    return count;
  }
  /// Place of a node in the order of all nodes, x fastest.
  std::size_t row(const Index<Dim>& node) const {
    std::size_t row = 0;
    for (int d = Dim - 1; d >= 0; --d) {
      row = row * static_cast<std::size_t>(nodes(d)) + static_cast<std::size_t>(node[static_cast<std::size_t>(d)]);
    }
    return row;
  }
  /// The node at a place of that order.
  Index<Dim> index(std::size_t row) const {
    Index<Dim> node;
    for (int d = 0; d < Dim; ++d) {
      const auto count = static_cast<std::size_t>(nodes(d));
      node[static_cast<std::size_t>(d)] = static_cast<int>(row % count);
      row /= count;
    }
    return node;
  }
  /// Where a node is. [m]
  Vec<Dim> position(const Index<Dim>& node) const {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = low[d] + spacing * node[static_cast<std::size_t>(d)];
    return x;
  }
};

/// What the sides of the box do to the liquid: per axis the low and the high end.
template <int Dim>
struct Walls {
  /// Components of the displacement that are zero, bit d for direction d. [1]
  std::array<std::array<std::uint8_t, 2>, static_cast<std::size_t>(Dim)> held{};
  /// 1/b of the slip length b; 0 where nothing rubs along the wall, or where it holds the liquid. [1/m]
  std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)> per_slip_length{};
  static constexpr ComponentInfo info{"walls", "1/b", "1/m", Lifetime::constant};
};

}  // namespace minamo
