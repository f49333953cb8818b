#pragma once
/// \file
/// (E136) Small cells around the thin walls of a body, in the frame of its shape: between which of them walls lie, and
/// how thick these are.

#include "systems/bodies/geometry/small_cells.hpp"
#include "systems/shapes/shape.hpp"

#include <optional>
#include <vector>

namespace minamo {

/// Found once: it does not depend on where the liquid is.
template <int Dim>
class WallCells {
 public:
  static constexpr std::int32_t none = SmallCells<Dim>::none;
  /// What is hidden, or dry, is behind a wall by more than this. [h]
  static constexpr double detour = 1;

  /// \param region  where liquid may be [m]
  /// \param thin    walls thinner than so many cells are: splines reach no farther [1]
  /// \return none if no wall in the region is thin
  static std::optional<WallCells> find(const Shape<Dim>& shape, const Bounds<Dim>& region, double spacing, int thin);

  const SmallCells<Dim>& cells() const { return cells_; }
  int thin() const { return thin_; }
  /// Blocks farther from a thin wall than this are not kept.
  int reach() const { return thin_ + 1; }
  /// Bits, from 0 on one per side, 2 d below and 2 d + 1 above along axis d: that no wall parts the small cell from its
  /// neighbour there.
  unsigned open_sides(std::size_t small) const { return flags_[small]; }
  bool is_open_to(std::size_t small, std::size_t side) const { return has(small, side); }
  /// Whether the middle of a small cell is outside of the body.
  bool is_open(std::size_t small) const { return has(small, is_open_bit); }
  /// Of the wall next to a small cell, 0 without any. [m]
  double thickness(std::size_t small) const { return static_cast<double>(thickness_[small]); }
  /// Small cells next to a thin wall, and those behind it.
  struct Opposites {
    std::int32_t one;
    std::int32_t other;
  };
  const std::vector<Opposites>& opposites() const { return opposites_; }
  /// The small cell that tells of a point: that on its side of the nearest wall.
  /// \param distance  of the point from the body [m]
  std::int32_t telling(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;

 private:
  /// Of `flags`, behind those of the sides.
  static constexpr unsigned is_open_bit = 2 * Dim;

  WallCells(const Bounds<Dim>& region, double spacing, int thin)
      : region_(region), cells_(region, spacing), thin_(thin) {}
  bool has(std::size_t small, std::size_t flag) const { return (flags_[small] >> flag & 1U) != 0; }
  /// Wall next to an open point at a distance from it, along its normal; at most that of a thin one. [m]
  double thickness_at(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;
  /// Whether a point is in the region, and farther from its sides than so much. [m]
  bool is_inside(const Vec<Dim>& x, double margin) const;
  void join(const Shape<Dim>& shape);
  void find_opposites(const Shape<Dim>& shape);
  /// To small cells farther from the wall; and the least up to half a cell away, because where two walls meet the
  /// normal of one leads along the other.
  void spread_thickness();
  /// telling() in a corner of the body, where the way along the normal of one of its sides ends in another one.
  std::int32_t in_corner(const Shape<Dim>& shape, const Vec<Dim>& x) const;
  /// Whether the body lies between two open points.
  bool is_parted(const Shape<Dim>& shape, const Vec<Dim>& x, double at_x, const Vec<Dim>& y, double at_y) const;

  Bounds<Dim> region_;
  SmallCells<Dim> cells_;
  int thin_;
  std::vector<std::uint8_t> flags_;
  std::vector<float> thickness_;  ///< [m]
  std::vector<Opposites> opposites_;
};

}  // namespace minamo
