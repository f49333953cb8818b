#pragma once
/// \file
/// What a particle brings to the faces around it: a series in the way from the particle to a face, of which an affine
/// one, and a quadratic one as far as the splines hold it, arrives as it is.

#include "systems/grid/lanes.hpp"
#include "systems/transfer/jet.hpp"

#include <tuple>

namespace minamo {

namespace series {

/// q_f = q.
template <int Dim>
struct Constant {
  static constexpr int order = 0;  ///< of the series
  Vec<Dim> value;                  ///< q of the particle
};

/// q_f = q + grad q r, r = x_f - y, x_f the Greville points of the face.
template <int Dim>
struct Linear {
  static constexpr int order = 1;  ///< of the series
  Vec<Dim> value;                  ///< q of the particle
  Mat<Dim> gradient;               ///< grad q, row i of component i [1/m]
};

/// (E64) on faces: q_f = q + grad q r + sum_ab H_ab (r_a r_b - delta_ab s_a)/2, s_a the spread of the knots of the face
/// along an axis. The third term changes no momentum: sum_f N_f (r_a^2 - s_a) = 0. Hats, across at degree 2, hold no
/// squares, and get none.
template <int Dim>
struct Quadratic {
  static constexpr int order = 2;  ///< of the series
  Vec<Dim> value;                  ///< q of the particle
  Mat<Dim> gradient;               ///< grad q, row i of component i [1/m]
  SecondDerivatives<Dim> second;   ///< H [1/m^2]
};

}  // namespace series

/// The series of every lane, in units of h, and the ways to the faces of a cell.
template <int Dim, int K, class Series>
struct LaneSeries {
  static constexpr int order = Series::order;
  static constexpr auto dim = static_cast<std::size_t>(Dim);
  std::array<Four, dim> value;
  std::array<std::array<Four, dim>, dim> gradient;
  std::array<std::array<Four, dim*(dim + 1) / 2>, dim> second;
  SplineNumbers<Dim, K, Four> way;     ///< r_a
  SplineNumbers<Dim, K, Four> square;  ///< (r_a^2 - s_a)/2

  [[gnu::always_inline]] LaneSeries(const CellFrame<Dim>& frame, const LanePlace<Dim>& xi,
                                    const std::array<Series, lanes>& of) {
    const auto lane_by_lane = [&](const auto& part) {
      return Four{part(of[0]), part(of[1]), part(of[2]), part(of[3])};
    };
    for (int d = 0; d < Dim; ++d) {
      const auto row = static_cast<std::size_t>(d);
      value[row] = lane_by_lane([&](const Series& q) { return q.value[d]; });
      if constexpr (order > 0) {
        for (int e = 0; e < Dim; ++e) {
          gradient[row][static_cast<std::size_t>(e)] =
              frame.spacing * lane_by_lane([&](const Series& q) { return q.gradient(d, e); });
        }
      }
      if constexpr (order > 1) {
        for (int k = 0; k < static_cast<int>(second[row].size()); ++k) {
          second[row][static_cast<std::size_t>(k)] =
              (frame.spacing * frame.spacing) * lane_by_lane([&](const Series& q) { return q.second(d, k); });
        }
      }
    }
    if constexpr (order > 0) {
      for (std::size_t d = 0; d < Dim; ++d) {
        const CellSplines& in = *frame.splines[d];
        find_ways(xi[d], in.along_place, in.along_spread, way.along[d], square.along[d]);
        find_ways(xi[d], in.across_place, in.across_spread, way.across[d], square.across[d]);
      }
    }
  }

 private:
  template <class Numbers>
  [[gnu::always_inline]] static void find_ways(const Four& xi, const std::array<double, CellSplines::most>& place,
                                               const std::array<double, CellSplines::most>& spread, Numbers& r,
                                               Numbers& half_square) {
    for (std::size_t a = 0; a < r.size(); ++a) {
      r[a] = place[a] - xi;
      if constexpr (order > 1) half_square[a] = 0.5 * (r[a] * r[a] - spread[a]);
    }
  }
};

/// The series of every lane at the faces of direction D of a cell: what the way along every axis adds, and what pairs
/// of axes do.
template <int D, int Dim, int K, class Series>
class FaceSeries {
 public:
  using Lanes = LaneSeries<Dim, K, Series>;

  explicit FaceSeries(const Lanes& q) : q_(q) {
    for_each_direction<Dim>([&](auto axis) {
      constexpr int E = axis();
      auto& part = std::get<E>(part_);
      for (std::size_t a = 0; a < part.size(); ++a) part[a] = along<E>(a);
    });
  }
  /// Faces of a row along x, b the place of the row along y: a function of the place along x.
  auto row(std::size_t b) const {
    const Four start = std::get<1>(part_)[b];
    Four tilt{};
    if constexpr (Lanes::order > 1) tilt = mixed<0, 1>() * way<1>(b);
    return in_row(start, tilt);
  }
  /// In 3-D, c its place along z.
  auto row(std::size_t b, std::size_t c) const {
    Four start = std::get<1>(part_)[b] + std::get<2>(part_)[c];
    Four tilt{};
    if constexpr (Lanes::order > 1) {
      start += mixed<1, 2>() * way<1>(b) * way<2>(c);
      tilt = mixed<0, 1>() * way<1>(b) + mixed<0, 2>() * way<2>(c);
    }
    return in_row(start, tilt);
  }

 private:
  template <int Axis>
  using Part = std::array<Four, Axis == D ? K + 1 : K>;

  [[gnu::always_inline]] auto in_row(const Four& start, const Four& tilt) const {
    return [this, start, tilt](std::size_t a) -> Four {
      if constexpr (Lanes::order == 0) return std::get<0>(part_)[a];
      if constexpr (Lanes::order == 1) return start + std::get<0>(part_)[a];
      return start + std::get<0>(part_)[a] + tilt * way<0>(a);
    };
  }
  template <int Axis>
  [[gnu::always_inline]] Four along(std::size_t a) const {
    Four sum = Axis == 0 ? q_.value[D] : Four{};
    if constexpr (Lanes::order > 0) sum += q_.gradient[D][Axis] * way<Axis>(a);
    constexpr bool holds_squares = Axis == D || K > 2;  // hats do not
    if constexpr (Lanes::order > 1 && holds_squares) {
      sum += q_.second[D][static_cast<std::size_t>(second_along<Dim>(Axis))] * q_.square.template of<D, Axis>()[a];
    }
    return sum;
  }
  template <int Axis>
  [[gnu::always_inline]] const Four& way(std::size_t a) const {
    return q_.way.template of<D, Axis>()[a];
  }
  /// H_ab for a < b.
  template <int A, int B>
  [[gnu::always_inline]] const Four& mixed() const {
    return q_.second[D][static_cast<std::size_t>(second_along<Dim>(A) + B - A)];
  }

  const Lanes& q_;
  std::tuple<Part<0>, Part<1>, Part<Dim == 3 ? 2 : 1>> part_;
};

}  // namespace minamo
