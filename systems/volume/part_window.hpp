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
  std::vector<std::int32_t> around;  ///< of every own cell, the 3^d with itself, x fastest; -1: no particles there
  static constexpr ComponentInfo info{"stir.fill", "C", "1", Lifetime::scratch};

  template <int Dim>
  const std::int32_t* around_cell(std::size_t c) const {
    return around.data() + c * support_size<Dim>;
  }
};

/// C_s, how full bodies make the window of every occupied cell next to one. [1]
struct SolidParts {
  static constexpr std::int32_t none = -1;
  std::vector<std::int32_t> place;  ///< by occupied cell, among those near bodies
  std::vector<double> fill;         ///< (parts + 2)^d of each, x fastest
  static constexpr ComponentInfo info{"stir.solid", "C_s", "1", Lifetime::scratch};
};

/// Weights of the points of a group on three parts along every axis, quadratic B-splines, and their slopes per part.
template <int Dim>
struct PartWeights {
  struct Axis {
    std::array<std::int32_t, lanes> first;  ///< of the three parts in the window
    std::array<Four, 3> weight;
    std::array<Four, 3> slope;
  };
  std::array<Axis, static_cast<std::size_t>(Dim)> axis;

  [[gnu::always_inline]] PartWeights(const LanePlace<Dim>& xi, int parts) {
    for (std::size_t d = 0; d < Dim; ++d) {
      auto& [first, weight, slope] = axis[d];
      const Four s = xi[d] * static_cast<double>(parts);
      Four own;
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        first[lane] = std::min(static_cast<std::int32_t>(s[lane]), parts - 1);
        own[lane] = first[lane];
      }
      const Four r = s - own - 0.5;
      weight = {0.5 * (0.5 - r) * (0.5 - r), 0.75 - r * r, 0.5 * (0.5 + r) * (0.5 + r)};
      slope = {r - 0.5, -2.0 * r, r + 0.5};
    }
  }
  /// Place of the first of the 3^d parts of a point in a window of so many parts along every axis.
  [[gnu::always_inline]] std::size_t start(std::size_t lane, std::size_t side) const {
    std::size_t start = 0;
    for (std::size_t d = Dim; d-- > 0;) start = start * side + static_cast<std::size_t>(axis[d].first[lane]);
    return start;
  }
};

template <int Dim>
class PartWindow {
 public:
  static constexpr int most_parts = 16;

  /// \param around  PartFill::around of the cell
  PartWindow(int parts, const Splines<Dim>& splines, const Index<Dim>& cell, const std::int32_t* around)
      : parts_(parts),
        side_(static_cast<std::size_t>(parts) + 2),
        per_cell_(power(static_cast<std::size_t>(parts), Dim)),
        numbers_(power(side_, Dim) + 1),
        around_(around) {
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
    }
  }

  void clear() { std::fill_n(value_.begin(), numbers_, 0.0); }
  /// Adds amounts around the points of a group.
  [[gnu::always_inline]] void add(const Group& group, const LanePlace<Dim>& xi, const Four& amount) {
    const PartWeights<Dim> of(xi, parts_);
    const std::size_t side = side_;
    const auto x = transposed({of.axis[0].weight[0], of.axis[0].weight[1], of.axis[0].weight[2], Four{}});
    std::array<Four, lines> share;
    for (std::size_t n = 0; n < lines; ++n) {
      share[n] = amount * of.axis[1].weight[n % 3];
      if constexpr (Dim == 3) share[n] *= of.axis[2].weight[n / 3];
    }
    for (std::size_t lane = 0; lane < group.count; ++lane) {
      double* start = value_.data() + of.start(lane, side);
      for (std::size_t n = 0; n < lines; ++n) {
        double* line = start + (n / 3 * side + n % 3) * side;
        store(line, load(line) + share[n][lane] * x[lane]);
      }
    }
  }
  /// Adds what has been added to the parts of all cells.
  void add_to(std::span<double> fill) {
    for_each([&](const double& value, std::size_t at) { fill[at] += value; }, [](double&) {});
  }

  void load(std::span<const double> fill) {
    for_each([&](double& value, std::size_t at) { value = fill[at]; }, [](double& value) { value = 0; });
    value_[numbers_ - 1] = 0;
  }
  /// Adds what bodies fill of the window of the occupied cell c to what was loaded.
  void add(const SolidParts& solid, std::size_t c) {
    if (solid.place[c] == SolidParts::none) return;
    const std::size_t count = power(side_, Dim);
    const double* of = solid.fill.data() + static_cast<std::size_t>(solid.place[c]) * count;
    for (std::size_t k = 0; k < count; ++k) value_[k] += of[k];
  }
  /// Gradient at the points of a group of what was loaded, per part.
  [[gnu::always_inline]] LanePlace<Dim> gradient(const LanePlace<Dim>& xi) const {
    const PartWeights<Dim> of(xi, parts_);
    const std::size_t side = side_;
    // Of every point sums over y and z, by place along x: of the value, and of its slopes along y and z.
    std::array<std::array<Four, lanes>, static_cast<std::size_t>(Dim)> sums;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double* start = value_.data() + of.start(lane, side);
      const auto plane = [&](const double* first) {
        std::array<Four, 2> sum{};
        for (std::size_t b = 0; b < 3; ++b) {
          const Four line = load(first + b * side);
          sum[0] += of.axis[1].weight[b][lane] * line;
          sum[1] += of.axis[1].slope[b][lane] * line;
        }
        return sum;
      };
      if constexpr (Dim == 2) {
        const auto sum = plane(start);
        for (std::size_t k = 0; k < 2; ++k) sums[k][lane] = sum[k];
      } else {
        Four value{};
        Four along_y{};
        Four along_z{};
        for (std::size_t c = 0; c < 3; ++c) {
          const auto sum = plane(start + c * side * side);
          value += of.axis[2].weight[c][lane] * sum[0];
          along_y += of.axis[2].weight[c][lane] * sum[1];
          along_z += of.axis[2].slope[c][lane] * sum[0];
        }
        sums[0][lane] = value;
        sums[1][lane] = along_y;
        sums[2][lane] = along_z;
      }
    }
    LanePlace<Dim> gradient;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto& x = d == 0 ? of.axis[0].slope : of.axis[0].weight;
      const auto at = transposed(sums[d]);
      gradient[d] = x[0] * at[0] + x[1] * at[1] + x[2] * at[2];
    }
    return gradient;
  }

 private:
  static constexpr std::size_t lines = power(3, Dim - 1);  ///< of three parts along x, around a point
  using AxisMap = std::array<int, most_parts + 2>;

  /// use(value, place in PartFill::fill) for the parts of occupied cells, otherwise(value) for the others.
  template <class Use, class Otherwise>
  void for_each(const Use& use, const Otherwise& otherwise) {
    double* value = value_.data();
    // Along x: a part of the cell below, those of the cell itself, a part of the cell above.
    const auto row = [&](int cell, int part) {
      const auto piece = [&](std::size_t first, std::size_t count) {
        const std::int32_t c = around_[static_cast<std::size_t>(cell * 3 + cell_[0][first])];
        const std::size_t at =
            static_cast<std::size_t>(c) * per_cell_ + static_cast<std::size_t>(part * parts_ + part_[0][first]);
        for (std::size_t k = 0; k < count; ++k) {
          if (c < 0) {
            otherwise(value[k]);
          } else {
            use(value[k], at + k);
          }
        }
        value += count;
      };
      piece(0, 1);
      piece(1, side_ - 2);
      piece(side_ - 1, 1);
    };
    if constexpr (Dim == 2) {
      for (std::size_t b = 0; b < side_; ++b) row(cell_[1][b], part_[1][b]);
    } else {
      for (std::size_t c = 0; c < side_; ++c) {
        for (std::size_t b = 0; b < side_; ++b) row(cell_[2][c] * 3 + cell_[1][b], part_[2][c] * parts_ + part_[1][b]);
      }
    }
  }
  /// A line of three is read and written with the number behind it, whose weight is zero.
  static Four load(const double* line) {
    Four of;
    std::memcpy(&of, line, sizeof of);
    return of;
  }
  static void store(double* line, const Four& of) { std::memcpy(line, &of, sizeof of); }

  int parts_;
  std::size_t side_;
  std::size_t per_cell_;
  std::size_t numbers_;  ///< of the parts, and one behind the last line
  const std::int32_t* around_;
  std::array<AxisMap, static_cast<std::size_t>(Dim)> cell_;  ///< 0 below, 1 own, 2 above, by place in the window
  std::array<AxisMap, static_cast<std::size_t>(Dim)> part_;  ///< within that cell
  std::array<double, power(most_parts + 2, Dim) + 1> value_;
};

}  // namespace minamo
