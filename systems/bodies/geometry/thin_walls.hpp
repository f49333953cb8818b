#pragma once
/// \file
/// (E136) Walls so thin that the splines of a particle reach through them: which of their sides is dry.

#include "components/grid.hpp"
#include "systems/shapes/shape.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace minamo {

/// Small cells around the thin walls of a body, in the frame of its shape. Liquid lights its surroundings; a small cell
/// is dry if the way to it from the nearest liquid around walls is longer than the way through them by more than a
/// cell of the grid.
template <int Dim>
class ThinWalls {
 public:
  /// \param region  where liquid may be [m]
  /// \param thin    walls thinner than so many cells are: splines reach no farther [1]
  /// \return none if no wall in the region is thin
  static std::optional<ThinWalls> find(const Shape<Dim>& shape, const Bounds<Dim>& region, double spacing, int thin);

  /// From any thread: there is liquid at a point.
  void light(const Shape<Dim>& shape, const Vec<Dim>& x);
  /// Finds what is dry by the light since the last call.
  /// \return whether it has changed
  bool find_dry();
  /// Distance from the body with its dry sides, negative in there. \param distance  from the body [m]
  double shaded(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;

  /// A place in a thin wall.
  struct Place {
    Vec<Dim> middle;   ///< [m]
    double thickness;  ///< [m]
  };
  /// One with liquid nearer than a cell on both sides, by the last find_dry(), if there is any.
  std::optional<Place> wet_on_both_sides(const Shape<Dim>& shape) const;

  /// Whether anything dry has changed by the last find_dry() within so far of a point. [m]
  bool has_changed_near(const Vec<Dim>& x, double within) const;
  /// How far from the shape something may be dry. [m]
  double reach_of_dry() const { return reach() * spacing_; }

 private:
  static constexpr std::int32_t none = -1;
  /// Small cells per cell of the grid and direction.
  static constexpr int fineness = Dim == 2 ? 8 : 4;
  static constexpr std::size_t per_block = power(fineness, Dim);
  /// Blocks farther from a thin wall than this are not kept.
  int reach() const { return thin_ + 1; }

  /// Bits of `flags`: from 0 on one per side, 2 d below and 2 d + 1 above along axis d, that no wall parts the small
  /// cell from its neighbour there; and whether its middle is outside of the body.
  static constexpr unsigned is_open = 2 * Dim;

  ThinWalls(const Bounds<Dim>& region, double spacing, int thin);
  /// Wall next to an open point at a distance from it, along its normal; at most that of a thin one. [m]
  double thickness_at(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;
  bool is_inside(const Vec<Dim>& x) const;
  void keep_blocks(const std::vector<std::uint8_t>& is_thin);
  void join(const Shape<Dim>& shape);
  /// To small cells farther from the wall; and the least up to half a cell away, because where two walls meet the
  /// normal of one leads along the other.
  void spread_thickness();
  Vec<Dim> middle_of_block(std::size_t block) const;
  /// Of a small cell by its number in a block, or among all.
  Vec<Dim> middle_within(std::size_t block, std::size_t within) const;
  Vec<Dim> middle_of_small(std::size_t small) const {
    return middle_within(kept_[small / per_block], small % per_block);
  }
  std::int32_t small_at(const Vec<Dim>& x) const;
  std::int32_t neighbour(std::size_t small, std::size_t side) const;
  bool has(std::size_t small, std::size_t flag) const { return (flags_[small] >> flag & 1U) != 0; }
  /// The small cell that tells of a point: that on its side of the nearest wall.
  std::int32_t telling(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;
  /// Steps from the lit small cells, at most so many; -1 beyond.
  void spread(bool through_walls, int most, std::vector<std::int16_t>& steps) const;

  Bounds<Dim> region_;
  /// Of the blocks: half a small cell below that of the region, so that points of the grid are in the middle of small
  /// cells, and rounding does not say in which. [m]
  Vec<Dim> low_;
  double spacing_;
  int thin_;
  Index<Dim> blocks_{};              ///< of the size of a cell, along every axis
  std::vector<std::int32_t> first_;  ///< small cell of every block, or none
  std::vector<std::uint32_t> kept_;  ///< the blocks that have any
  std::vector<std::array<std::int32_t, 2 * static_cast<std::size_t>(Dim)>> beside_;  ///< first_ of blocks next to them
  std::vector<std::uint8_t> flags_;
  std::vector<float> thickness_;       ///< of the wall next to a small cell, 0 without any [m]
  std::vector<std::uint8_t> is_lit_;   ///< since the last find_dry()
  std::vector<std::uint8_t> was_lit_;  ///< at the last one
  std::vector<std::uint8_t> is_dry_;
  std::vector<std::uint8_t> has_changed_;  ///< of kept blocks, by the last find_dry()
  std::vector<std::int16_t> around_, through_;
};

}  // namespace minamo
