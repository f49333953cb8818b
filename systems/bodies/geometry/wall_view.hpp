#pragma once
/// \file
/// (E136) What thin walls that are wet on both sides hide from a place.

#include "systems/bodies/geometry/wall_cells.hpp"

#include <span>

namespace minamo {

/// A window of small cells around a place: which of them lie behind a wall.
template <int Dim>
struct WallView {
  /// How far a view goes, in cells of the grid: two of them away, whichever way the shape is turned; and its window, in
  /// small cells.
  static constexpr int half = 3;
  static constexpr int across = 2 * half * SmallCells<Dim>::fineness + 1;

  std::vector<std::int32_t> from;    ///< small cells nearest to the place where liquid may be
  bool hides_all = false;            ///< it is in the middle of a wall, and on none of its sides
  Index<Dim> low{};                  ///< of the window, by small cells along every axis
  std::vector<std::uint8_t> hidden;  ///< of the window, x fastest; empty: it hides nothing

  bool hides(const SmallCells<Dim>& cells, std::int32_t small) const;
};

/// What views depend on besides the walls, by small cell.
struct WallLight {
  std::span<const std::uint8_t> is_dry;
  std::span<const std::uint8_t> has_place;  ///< whether there is a grid at its middle; empty: everywhere
};

/// \param former  a view near which there was grid where there is now, taken if it is from the same small cells; may be
///                null
/// \return none where liquid may be nowhere near
template <int Dim>
std::optional<WallView<Dim>> view_from(const WallCells<Dim>& walls, const WallLight& light, const Shape<Dim>& shape,
                                       const Vec<Dim>& x, WallView<Dim>* former);

}  // namespace minamo
