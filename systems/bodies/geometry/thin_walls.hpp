#pragma once
/// \file
/// (E136) Walls so thin that the splines of a particle reach through them: which of their sides is dry, and what they
/// hide of a wet one.

#include "components/grid.hpp"
#include "engine/run/communicator.hpp"
#include "systems/shapes/shape.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
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
  /// What any rank has lit all have lit.
  void share_light(Communicator& ranks);
  /// Finds what is dry by the light since the last call.
  /// \return whether that has changed, or where walls are wet on both sides
  bool find_dry();

  /// What thin walls hide from a place.
  struct View {
    std::vector<std::int32_t> from;    ///< small cells nearest to it where liquid may be
    bool hides_all = false;            ///< it is in the middle of a wall, and on none of its sides
    Index<Dim> low{};                  ///< of the window, by small cells along every axis
    std::vector<std::uint8_t> hidden;  ///< of the window, x fastest; empty: it hides nothing
  };
  /// Whether a wall near a point is wet on both sides, by the last find_dry(): elsewhere nothing wet is hidden.
  bool may_hide_at(const Vec<Dim>& x) const;
  /// Whether that is so anywhere.
  bool may_hide_any() const { return !two_sided_.empty(); }
  /// Whether the last find_dry() has changed anything that a view from there depends on.
  bool has_new_view_at(const Vec<Dim>& x) const;
  /// \param has_place  has_place(x): whether there is a grid at a point; may be empty: everywhere
  /// \return none where liquid may be nowhere near
  std::optional<View> view_from(const Shape<Dim>& shape, const Vec<Dim>& x,
                                const std::function<bool(const Vec<Dim>&)>& has_place = {}) const;
  /// Whether a view hides a small cell.
  bool hides(const View& view, std::int32_t small) const;
  /// Whether two places are hidden from each other.
  bool parts(const View& one, const View& other) const {
    const auto hidden_by = [&](const View& view) {
      return [this, &view](std::int32_t small) { return hides(view, small); };
    };
    return std::any_of(other.from.begin(), other.from.end(), hidden_by(one)) ||
           std::any_of(one.from.begin(), one.from.end(), hidden_by(other));
  }
  /// The small cell that tells of a point: that on its side of the nearest wall, if it is near any.
  std::optional<std::int32_t> small_cell_of(const Shape<Dim>& shape, const Vec<Dim>& x) const;
  /// Distance from the body with its dry sides and what is hidden, negative in there.
  /// \param distance  from the body [m]
  /// \param view      null: only dry sides count
  double shaded(const Shape<Dim>& shape, const Vec<Dim>& x, double distance, const View* view = nullptr) const;

  /// A place in a thin wall.
  struct Place {
    Vec<Dim> middle;   ///< [m]
    double thickness;  ///< [m]
  };
  /// One thinner than so much with liquid nearer than a cell on both sides, by the last find_dry(), if there is any.
  std::optional<Place> wet_on_both_sides(const Shape<Dim>& shape, double thinner_than) const;

  /// Whether anything dry has changed by the last find_dry() within so far of a point. [m]
  bool has_changed_near(const Vec<Dim>& x, double within) const;
  /// How far from the shape something may be dry. [m]
  double reach_of_dry() const { return reach() * spacing_; }

 private:
  static constexpr std::int32_t none = -1;
  /// Small cells per cell of the grid and direction.
  static constexpr int fineness = Dim == 2 ? 8 : 4;
  static constexpr std::size_t per_block = power(fineness, Dim);
  /// How far a view goes, in cells of the grid: two of them away, whichever way the shape is turned; and its window, in
  /// small cells.
  static constexpr int half_a_view = 3;
  static constexpr int view_across = 2 * half_a_view * fineness + 1;
  /// Blocks farther from a thin wall than this are not kept.
  int reach() const { return thin_ + 1; }

  /// Bits of `flags`: from 0 on one per side, 2 d below and 2 d + 1 above along axis d, that no wall parts the small
  /// cell from its neighbour there; and whether its middle is outside of the body.
  static constexpr unsigned is_open = 2 * Dim;

  ThinWalls(const Bounds<Dim>& region, double spacing, int thin);
  /// Wall next to an open point at a distance from it, along its normal; at most that of a thin one. [m]
  double thickness_at(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;
  /// Whether a point is in the region, and farther from its sides than so much. [m]
  bool is_inside(const Vec<Dim>& x, double margin) const;
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
  /// The small cell at a place, and the place of a point or of a small cell, by small cells along every axis.
  std::int32_t small_at(const Index<Dim>& place) const;
  std::int32_t small_at(const Vec<Dim>& x) const;
  std::optional<Index<Dim>> place_of(const Vec<Dim>& x) const;
  Index<Dim> place_of(std::int32_t small) const;
  std::int32_t neighbour(std::size_t small, std::size_t side) const;
  bool has(std::size_t small, std::size_t flag) const { return (flags_[small] >> flag & 1U) != 0; }
  /// The small cell that tells of a point: that on its side of the nearest wall.
  std::int32_t telling(const Shape<Dim>& shape, const Vec<Dim>& x, double distance) const;
  /// The same in a corner of the body, where the way along the normal of one of its sides ends in another one.
  std::int32_t in_corner(const Shape<Dim>& shape, const Vec<Dim>& x) const;
  /// Whether the body lies between two open points.
  bool is_parted(const Shape<Dim>& shape, const Vec<Dim>& x, double at_x, const Vec<Dim>& y, double at_y) const;
  /// Small cells next to a thin wall, and those behind it.
  void find_opposites(const Shape<Dim>& shape);
  bool find_two_sided();
  /// Kept blocks within so many of marked ones.
  std::vector<std::uint8_t> blocks_near(const std::vector<std::uint8_t>& blocks, int within) const;
  /// Of the window of a view, x fastest: its small cells, and the steps to them around walls, or -1.
  std::vector<std::int32_t> small_cells_from(const Index<Dim>& low) const;
  std::vector<std::int16_t> steps_around(const std::vector<std::int32_t>& small,
                                         const std::vector<std::size_t>& starts) const;
  /// What of a window walls hide from some of its small cells, 1 or 0.
  std::vector<std::uint8_t> hidden_from(const std::vector<std::int32_t>& small,
                                        const std::vector<std::size_t>& starts) const;
  bool may_be_wet(std::int32_t small) const {
    return small != none && has(static_cast<std::size_t>(small), is_open) &&
           is_dry_[static_cast<std::size_t>(small)] == 0;
  }
  bool is_wet(std::int32_t small) const {
    const std::int16_t steps = around_[static_cast<std::size_t>(small)];
    return steps >= 0 && steps <= fineness;
  }
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
  struct Opposites {
    std::int32_t one;
    std::int32_t other;
  };
  std::vector<Opposites> opposites_;
  std::vector<std::int32_t> two_sided_;     ///< small cells next to walls that are wet on both sides, rising
  std::vector<std::uint8_t> has_new_view_;  ///< kept blocks near what the last find_dry() has changed
  std::vector<std::uint8_t> may_hide_;  ///< kept blocks near walls that are wet on both sides, by the last find_dry()
};

}  // namespace minamo
