#pragma once
/// \file
/// The columns of particles that wait outside of an opening.

#include "systems/openings/opening_set.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace minamo {

/// How many columns an opening has along an axis that lies in its side.
template <int Dim>
std::size_t columns_along(const Opening<Dim>& opening, const Grid<Dim>& grid, std::size_t axis);
/// How many it has.
template <int Dim>
std::size_t columns_of(const Opening<Dim>& opening, const Grid<Dim>& grid);

/// The columns of an opening.
template <int Dim>
class Columns {
 public:
  Columns(const Opening<Dim>& opening, const Grid<Dim>& grid)
      : grid_(grid), axis_(opening.side / 2), spacing_(opening.spacing(grid)) {
    for (std::size_t e = 0; e < Dim; ++e) count_[e] = e == axis_ ? 1 : columns_along<Dim>(opening, grid, e);
  }
  std::size_t size() const {
    std::size_t size = 1;
    for (const std::size_t count : count_) size *= count;
    return size;
  }
  double spacing() const { return spacing_; }
  /// Calls use(nearest column, place) for all columns, and those further out that drift in within a step: they are as
  /// far as the last one.
  template <class Use>
  void for_each_that_may_come(const Vec<Dim>& drift, const Vec<Dim>& along, double plane, const Use& use) const {
    std::array<std::int64_t, static_cast<std::size_t>(Dim)> number{};
    std::array<std::int64_t, static_cast<std::size_t>(Dim)> beyond{};
    for (std::size_t e = 0; e < Dim; ++e) {
      const bool may_be_beyond = e != axis_ && !grid_.periodic[e];
      if (may_be_beyond)
        beyond[e] = static_cast<std::int64_t>(std::abs(along[static_cast<Eigen::Index>(e)]) / spacing_) + 1;
      number[e] = -beyond[e];
    }
    for (;;) {
      std::size_t nearest = 0;
      Vec<Dim> x;
      for (std::size_t e = Dim; e-- > 0;) {
        const auto count = static_cast<std::int64_t>(count_[e]);
        nearest = nearest * count_[e] + static_cast<std::size_t>(std::clamp<std::int64_t>(number[e], 0, count - 1));
        x[static_cast<Eigen::Index>(e)] = e == axis_ ? plane : place(e, number[e], drift);
      }
      use(nearest, x);
      std::size_t e = 0;
      while (e < Dim && ++number[e] == static_cast<std::int64_t>(count_[e]) + beyond[e]) {
        number[e] = -beyond[e];
        ++e;
      }
      if (e == Dim) return;
    }
  }
  /// Where a column meets the side when it has drifted; one before the low end of axes with walls.
  Vec<Dim> place(std::size_t k, const Vec<Dim>& drift, double plane) const {
    Vec<Dim> x;
    for (std::size_t e = 0; e < Dim; ++e) {
      x[static_cast<Eigen::Index>(e)] = e == axis_ ? plane : place(e, static_cast<std::int64_t>(k % count_[e]), drift);
      k /= count_[e];
    }
    return x;
  }
  /// Whether a particle comes in at a point of the side, and not beyond its ends. Of one that comes over an edge
  /// between two with inflow the first of the scene has it, whatever rounding says; of one that comes at the very edge
  /// of another side, as it does when the columns move away from that.
  /// \param number  of the opening
  /// \param along   way of the columns along the side
  bool is_on_side(const Vec<Dim>& x, const OpeningSet<Dim>& set, const Splines<Dim>& splines, std::size_t number,
                  const Vec<Dim>& along) const {
    constexpr double rounding = 1e-8;
    for (std::size_t e = 0; e < Dim; ++e) {
      if (e == axis_ || grid_.periodic[e]) continue;
      const auto d = static_cast<Eigen::Index>(e);
      for (const std::size_t end : {0, 1}) {
        const double inside = end == 0 ? x[d] - grid_.low[d] : grid_.high[d] - x[d];
        if (inside > rounding * spacing_) continue;
        const int adjacent = set.at(grid_, splines, 2 * e + end, x);
        const bool is_own = adjacent != no_opening && set.openings[static_cast<std::size_t>(adjacent)].is_inflow()
                                ? static_cast<int>(number) < adjacent
                                : inward_of(2 * e + end) * along[d] > 0;
        if (!is_own || inside < -rounding * spacing_) return false;
      }
    }
    return true;
  }
  /// How a value of the columns at rest changes along the side at one of them: from those next to it that are on the
  /// side, zero along an axis without any. [unit/m]
  Vec<Dim> slope(std::span<const double> values, std::size_t k) const {
    Vec<Dim> slope = Vec<Dim>::Zero();
    std::size_t stride = 1;
    for (std::size_t e = 0; e < Dim; stride *= count_[e++]) {
      if (e == axis_) continue;
      const std::size_t own = k / stride % count_[e];
      std::size_t low = own > first_on_side(e) ? own - 1 : own;
      std::size_t high = own + 1 < count_[e] - first_on_side(e) ? own + 1 : own;
      double distance = static_cast<double>(high - low) * spacing_;
      if (grid_.periodic[e]) {
        low = (own + count_[e] - 1) % count_[e];
        high = (own + 1) % count_[e];
        distance = 2 * spacing_;
      }
      if (distance == 0) continue;
      const std::size_t base = k - own * stride;
      slope[static_cast<Eigen::Index>(e)] = (values[base + high * stride] - values[base + low * stride]) / distance;
    }
    return slope;
  }
  /// Takes whole spacings from the drift, so that columns change their numbers: it is at most half of one.
  void renumber(Vec<Dim>& drift, std::span<double> values) const {
    for (std::size_t e = 0; e < Dim; ++e) {
      double& along = drift[static_cast<Eigen::Index>(e)];
      for (; along > 0.5 * spacing_; along -= spacing_) shift(e, -1, values);
      for (; along < -0.5 * spacing_; along += spacing_) shift(e, 1, values);
    }
  }

 private:
  /// Of a column along an axis; with walls number 0 is one before the low end.
  double place(std::size_t e, std::int64_t number, const Vec<Dim>& drift) const {
    const auto d = static_cast<Eigen::Index>(e);
    return grid_.low[d] + spacing_ * (static_cast<double>(number) + (grid_.periodic[e] ? 0.5 : -0.5)) + drift[d];
  }
  /// Number of the first column along an axis that is on the side while the columns do not drift.
  std::size_t first_on_side(std::size_t e) const { return grid_.periodic[e] ? 0 : 1; }
  /// Column k gets the value of column k + by along an axis.
  void shift(std::size_t e, std::int64_t by, std::span<double> values) const {
    const std::vector<double> old(values.begin(), values.end());
    const auto count = static_cast<std::int64_t>(count_[e]);
    std::size_t stride = 1;
    for (std::size_t g = 0; g < e; ++g) stride *= count_[g];
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto own = static_cast<std::int64_t>(k / stride) % count;
      std::int64_t from = own + by;
      from = grid_.periodic[e] ? (from + count) % count : std::clamp<std::int64_t>(from, 0, count - 1);
      values[k] = old[static_cast<std::size_t>(static_cast<std::int64_t>(k) +
                                               (from - own) * static_cast<std::int64_t>(stride))];
    }
  }

  const Grid<Dim>& grid_;
  std::size_t axis_;
  double spacing_;
  std::array<std::size_t, static_cast<std::size_t>(Dim)> count_{};
};

/// The numbers of the columns of an opening among those of all.
template <int Dim, class Use>
void for_each_opening(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Use& use) {
  std::size_t first = 0;
  for (std::size_t o = 0; o < set.openings.size(); ++o) {
    const std::size_t count = columns_of<Dim>(set.openings[o], grid);
    use(o, first, count);
    first += count;
  }
}

}  // namespace minamo
