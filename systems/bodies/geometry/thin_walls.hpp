#pragma once
/// \file
/// (E136) Walls so thin that the splines of a particle reach through them: which of their sides is dry, and what they
/// hide of a wet one.

#include "engine/run/communicator.hpp"
#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/wall_view.hpp"

#include <algorithm>
#include <atomic>

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

  using View = WallView<Dim>;
  /// Whether a wall near a point is wet on both sides, by the last find_dry(): elsewhere nothing wet is hidden.
  bool may_hide_at(const Vec<Dim>& x) const;
  /// Whether that is so anywhere.
  bool may_hide_any() const { return !two_sided_.empty(); }
  /// Whether the last find_dry() has changed anything that a view from there depends on.
  bool has_new_view_at(const Vec<Dim>& x) const;
  /// Tells where there is a grid; before the first call it is everywhere.
  /// \param is_in_grid  is_in_grid(x), of the middles of small cells, from any thread
  template <class IsInGrid>
  void find_places(const IsInGrid& is_in_grid);
  /// \param former  from about there, before the last find_places(); it is taken if it is the same; may be null
  /// \return none where liquid may be nowhere near
  std::optional<View> view_from(const Shape<Dim>& shape, const Vec<Dim>& x, View* former = nullptr) const {
    const std::int32_t small = walls_.cells().at(x);
    const bool may_stay = small != none && has_new_places_[static_cast<std::size_t>(small) / per_block] == 0;
    return minamo::view_from<Dim>(walls_, {is_dry_, has_place_}, shape, x, may_stay ? former : nullptr);
  }
  /// Whether a view hides a small cell.
  bool hides(const View& view, std::int32_t small) const { return view.hides(walls_.cells(), small); }
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
  double reach_of_dry() const { return walls_.reach() * walls_.cells().spacing(); }

 private:
  static constexpr std::int32_t none = WallCells<Dim>::none;
  static constexpr int fineness = SmallCells<Dim>::fineness;
  static constexpr std::size_t per_block = SmallCells<Dim>::per_block;

  explicit ThinWalls(WallCells<Dim> walls);
  bool find_two_sided();
  bool is_wet(std::int32_t small) const {
    const std::int16_t steps = around_[static_cast<std::size_t>(small)];
    return steps >= 0 && steps <= fineness;
  }
  /// Steps from the lit small cells, at most so many; -1 beyond.
  void spread(bool through_walls, int most, std::vector<std::int16_t>& steps) const;

  WallCells<Dim> walls_;
  std::vector<std::uint8_t> is_lit_;   ///< since the last find_dry()
  std::vector<std::uint8_t> was_lit_;  ///< at the last one
  std::vector<std::uint8_t> is_dry_;
  std::vector<std::uint8_t> has_place_;       ///< whether there is a grid; empty: everywhere
  std::vector<std::uint8_t> has_new_places_;  ///< kept blocks near what the last find_places() has changed
  std::vector<std::uint8_t> has_changed_;     ///< of kept blocks, by the last find_dry()
  std::vector<std::int16_t> around_, through_;
  std::vector<std::int32_t> two_sided_;     ///< small cells next to walls that are wet on both sides, rising
  std::vector<std::uint8_t> has_new_view_;  ///< kept blocks near what the last find_dry() has changed
  std::vector<std::uint8_t> may_hide_;  ///< kept blocks near walls that are wet on both sides, by the last find_dry()
};

template <int Dim>
template <class IsInGrid>
void ThinWalls<Dim>::find_places(const IsInGrid& is_in_grid) {
  const SmallCells<Dim>& cells = walls_.cells();
  has_place_.resize(cells.size(), 1);
  std::vector<std::uint8_t> changed(cells.kept(), 0);
  for_each_row(cells.kept(), [&](std::size_t k) {
    for (std::size_t s = k * per_block; s < (k + 1) * per_block; ++s) {
      const std::uint8_t has_place = is_in_grid(cells.middle(s)) ? 1 : 0;
      if (has_place != has_place_[s]) changed[k] = 1;
      has_place_[s] = has_place;
    }
  });
  has_new_places_ = cells.blocks_near(changed, View::half);
}

}  // namespace minamo
