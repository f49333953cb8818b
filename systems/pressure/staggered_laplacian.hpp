#pragma once
/// \file
/// The matrix of a step on a staggered grid, S = Inc A^-1 Inc^T with diagonal A, as its solvers see it: a row per wet
/// cell, coupled to the cells across its faces only. Nothing of who assembles it.

#include "components/types.hpp"

#include <span>
#include <vector>

namespace minamo {

/// Right-hand sides, or solutions, that are solved for at once.
inline constexpr std::size_t most_sources = 3;
/// Those of one row, side by side.
using Sources = std::array<double, most_sources>;

/// A view of S, symmetric and positive semidefinite. Rows are in the order of their sites, x fastest.
template <int Dim>
struct StaggeredLaplacian {
  static constexpr auto sides = 2 * static_cast<std::size_t>(Dim);
  /// Rows at the low side [2d] and the high side [2d + 1] of axis d; -1: none. No row is its own neighbour.
  using Neighbours = std::array<std::int32_t, sides>;
  using Conductances = std::array<double, static_cast<std::size_t>(Dim)>;

  std::span<const Index<Dim>> site;
  std::span<const Neighbours> neighbour;
  std::span<const Conductances> conductance;  ///< to the neighbour at the high side of axis d: -S_lm >= 0, 0 if none
  std::span<const double> diagonal;           ///< S_ll > 0
  Index<Dim> counts{};                        ///< sites per axis
  std::array<bool, static_cast<std::size_t>(Dim)> periodic{};  ///< where the last site is the first one's neighbour

  std::size_t rows() const { return diagonal.size(); }

  /// body(m, -S_lm) for all neighbours m of row l.
  template <class Body>
  void for_each_neighbour(std::size_t l, const Body& body) const {
    for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d) {
      const std::int32_t low = neighbour[l][2 * d];
      const std::int32_t high = neighbour[l][2 * d + 1];
      if (low >= 0) body(static_cast<std::size_t>(low), conductance[static_cast<std::size_t>(low)][d]);
      if (high >= 0) body(static_cast<std::size_t>(high), conductance[l][d]);
    }
  }
};

}  // namespace minamo
