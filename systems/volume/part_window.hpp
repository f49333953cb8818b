#pragma once
/// \file
/// The parts of a cell, d^Dim of them, with one more of its neighbours on every side: where the particles of a cell
/// have weight on the grid of the parts. It is filled or read once per cell, so that a particle finds its 3^Dim parts
/// side by side.

#include "components/staggered.hpp"
#include "systems/grid/lanes.hpp"

namespace minamo {

/// How full the parts of every occupied cell are, parts^d of them, x fastest. [1]
struct PartFill {
  std::vector<double> fill;
  std::vector<std::int32_t> cell_of_site;  ///< by row of the lowest site of the cell, of several the first; -1: none
  static constexpr ComponentInfo info{"stir.fill", "C", "1", Lifetime::scratch};
};

/// C_s, how full bodies make the window of every occupied cell next to one. [1]
struct SolidParts {
  static constexpr std::int32_t none = -1;
  std::vector<std::int32_t> place;  ///< by occupied cell, among those near bodies
  std::vector<double> fill;         ///< (parts + 2)^d of each, x fastest
  static constexpr ComponentInfo info{"stir.solid", "C_s", "1", Lifetime::scratch};
};

/// Weights of a point on three parts along an axis, quadratic B-splines, and their slopes per part.
struct PartWeights {
  std::size_t first;  ///< in the window
  std::array<double, 3> weight;
  std::array<double, 3> slope;

  PartWeights(double xi, int parts) {
    const double s = xi * parts;
    const int own = std::min(static_cast<int>(s), parts - 1);
    const double r = s - own - 0.5;
    first = static_cast<std::size_t>(own);
    weight = {0.5 * (0.5 - r) * (0.5 - r), 0.75 - r * r, 0.5 * (0.5 + r) * (0.5 + r)};
    slope = {r - 0.5, -2 * r, r + 0.5};
  }
};

template <int Dim>
class PartWindow {
 public:
  static constexpr int most_parts = 16;

  /// \param around  around(offset): of the 3^d cells with the cell itself, offsets 0 ... 2, its number, or -1: no
  ///                particles there
  template <class Around>
  PartWindow(int parts, const Splines<Dim>& splines, const Index<Dim>& cell, const Around& around)
      : parts_(parts), side_(static_cast<std::size_t>(parts) + 2) {
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { around_[k] = around(offset); });
    per_cell_ = 1;
    for (std::size_t d = 0; d < Dim; ++d) {
      const SplineAxis& axis = splines.axis[d];
      const bool low_wall = !axis.periodic() && cell[d] == 0;
      const bool high_wall = !axis.periodic() && cell[d] + 1 == axis.cells();
      // Beyond a wall lies the mirror image.
      for (std::size_t k = 0; k < side_; ++k) {
        const int at = static_cast<int>(k) - 1;
        cell_[d][k] = at < 0 ? (low_wall ? 1 : 0) : at >= parts ? (high_wall ? 1 : 2) : 1;
        part_[d][k] = at < 0 ? (low_wall ? 0 : parts - 1) : at >= parts ? (high_wall ? parts - 1 : 0) : at;
      }
      per_cell_ *= static_cast<std::size_t>(parts);
    }
  }

  void clear() { std::fill_n(value_.begin(), power(side_, Dim) + 1, 0.0); }
  void load(std::span<const double> fill) {
    for_each([&](double& value, std::size_t at) { value = fill[at]; }, [](double& value) { value = 0; });
    value_[power(side_, Dim)] = 0;
  }
  void add_to(std::span<double> fill) {
    for_each([&](const double& value, std::size_t at) { fill[at] += value; }, [](double&) {});
  }

  /// Adds what bodies fill of the window of the occupied cell c.
  void add(const SolidParts& solid, std::size_t c) {
    if (solid.place[c] == SolidParts::none) return;
    const std::size_t count = power(side_, Dim);
    const double* of = solid.fill.data() + static_cast<std::size_t>(solid.place[c]) * count;
    for (std::size_t k = 0; k < count; ++k) value_[k] += of[k];
  }

  /// Adds an amount around a point.
  void add(const Vec<Dim>& xi, double amount) {
    const auto axis = weights(xi);
    const Four x = three(axis[0].weight);
    if constexpr (Dim == 2) {
      add_plane(x, axis[1], axis[1].first * side_ + axis[0].first, amount);
    } else {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t start = ((axis[2].first + c) * side_ + axis[1].first) * side_ + axis[0].first;
        add_plane(x, axis[1], start, amount * axis[2].weight[c]);
      }
    }
  }
  /// Gradient at a point, per part.
  Vec<Dim> gradient(const Vec<Dim>& xi) const {
    const auto axis = weights(xi);
    const Four weight = three(axis[0].weight);
    const Four slope = three(axis[0].slope);
    if constexpr (Dim == 2) {
      const auto [value, along_y] = plane_sums(axis[1], axis[1].first * side_ + axis[0].first);
      return {sum_of_lanes(slope * value), sum_of_lanes(weight * along_y)};
    } else {
      Four value{};
      Four along_y{};
      Four along_z{};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto of = plane_sums(axis[1], ((axis[2].first + c) * side_ + axis[1].first) * side_ + axis[0].first);
        value += axis[2].weight[c] * of.value;
        along_y += axis[2].weight[c] * of.along_y;
        along_z += axis[2].slope[c] * of.value;
      }
      return {sum_of_lanes(slope * value), sum_of_lanes(weight * along_y), sum_of_lanes(weight * along_z)};
    }
  }

 private:
  using AxisMap = std::array<int, most_parts + 2>;

  /// use(value, place in PartFill::fill) for the parts of occupied cells, otherwise(value) for the others.
  template <class Use, class Otherwise>
  void for_each(const Use& use, const Otherwise& otherwise) {
    std::size_t k = 0;
    const auto row = [&](int cell, int part) {
      for (std::size_t a = 0; a < side_; ++a, ++k) {
        const std::int32_t c = around_[static_cast<std::size_t>(cell * 3 + cell_[0][a])];
        if (c < 0) {
          otherwise(value_[k]);
        } else {
          use(value_[k],
              static_cast<std::size_t>(c) * per_cell_ + static_cast<std::size_t>(part * parts_ + part_[0][a]));
        }
      }
    };
    if constexpr (Dim == 2) {
      for (std::size_t b = 0; b < side_; ++b) row(cell_[1][b], part_[1][b]);
    } else {
      for (std::size_t c = 0; c < side_; ++c) {
        for (std::size_t b = 0; b < side_; ++b) row(cell_[2][c] * 3 + cell_[1][b], part_[2][c] * parts_ + part_[1][b]);
      }
    }
  }
  std::array<PartWeights, static_cast<std::size_t>(Dim)> weights(const Vec<Dim>& xi) const {
    if constexpr (Dim == 2) {
      return {PartWeights(xi[0], parts_), PartWeights(xi[1], parts_)};
    } else {
      return {PartWeights(xi[0], parts_), PartWeights(xi[1], parts_), PartWeights(xi[2], parts_)};
    }
  }
  /// Lines of three are read and written with the number behind them, whose weight is zero.
  static Four three(const std::array<double, 3>& of) { return {of[0], of[1], of[2], 0}; }
  Four line(std::size_t start) const {
    Four of;
    std::memcpy(&of, value_.data() + start, sizeof of);
    return of;
  }
  void add_plane(const Four& x, const PartWeights& y, std::size_t start, double amount) {
    for (std::size_t b = 0; b < 3; ++b) {
      const Four sum = line(start + b * side_) + amount * y.weight[b] * x;
      std::memcpy(value_.data() + start + b * side_, &sum, sizeof sum);
    }
  }
  /// Of the lines of a plane, by place along x: the value and its slope along y.
  struct PlaneSums {
    Four value;
    Four along_y;
  };
  PlaneSums plane_sums(const PartWeights& y, std::size_t start) const {
    PlaneSums sum{};
    for (std::size_t b = 0; b < 3; ++b) {
      const Four of = line(start + b * side_);
      sum.value += y.weight[b] * of;
      sum.along_y += y.slope[b] * of;
    }
    return sum;
  }

  int parts_;
  std::size_t side_;
  std::size_t per_cell_;
  std::array<std::int32_t, support_size<Dim>> around_;       ///< x fastest
  std::array<AxisMap, static_cast<std::size_t>(Dim)> cell_;  ///< 0 below, 1 own, 2 above, by place in the window
  std::array<AxisMap, static_cast<std::size_t>(Dim)> part_;  ///< within that cell
  std::array<double, power(most_parts + 2, Dim) + 1> value_;  ///< and one behind the last line
};

}  // namespace minamo
