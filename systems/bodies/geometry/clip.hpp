#pragma once
/// \file
/// Shares of segments, triangles and tetrahedra on one side of a plane, and of rectangles and lines on the open side of
/// a distance.

#include "components/types.hpp"

#include <algorithm>

namespace minamo {

/// Share of a simplex with N corners on which the function with these values at the corners, linear in between, is
/// positive: length of a segment (N = 2), area of a triangle (3), volume of a tetrahedron (4).
template <std::size_t N>
double positive_share(std::array<double, N> value) {
  std::sort(value.begin(), value.end(), std::greater<>());
  const auto positive =
      static_cast<std::size_t>(std::count_if(value.begin(), value.end(), [](double v) { return v > 0; }));
  if (positive == 0) return 0;
  if (positive == N) return 1;
  // The part of an edge from a positive corner to where the function is zero.
  const auto part = [&](std::size_t above, std::size_t below) { return value[above] / (value[above] - value[below]); };
  if (positive == 1) {
    double share = 1;
    for (std::size_t k = 1; k < N; ++k) share *= part(0, k);
    return share;
  }
  if (positive + 1 == N) {
    double share = 1;
    for (std::size_t k = 0; k + 1 < N; ++k) share *= 1 - part(k, N - 1);
    return 1 - share;
  }
  if constexpr (N == 4) {  // a wedge, of three tetrahedra
    const double ac = part(0, 2);
    const double ad = part(0, 3);
    const double bc = part(1, 2);
    const double bd = part(1, 3);
    return bc * bd + ac * ad * (1 - bd) + ac * bd * (1 - bc);
  }
  return 0;
}

/// Pieces per direction in which a face is clipped: a corner of a body is chamfered by less than one of them.
inline constexpr int clipped_pieces = 4;

/// How often a piece of a segment, or of a rectangle, is halved in search of something thin: down to 1/64 and 1/16 of a
/// face.
template <int Dim>
inline constexpr int halvings = Dim == 2 ? 4 : 2;

/// Share of a segment that lies where `distance` is positive. Between ends outside that are farther apart than both
/// distances together there may be something thin.
/// \param at_low, at_high  distances of the ends [m]
template <int Dim, class Distance>
double open_piece(const Vec<Dim>& low, const Vec<Dim>& high, double at_low, double at_high, int more_halvings,
                  const Distance& distance) {
  const bool may_hide = at_low > 0 && at_high > 0 && at_low + at_high < (high - low).norm();
  if (!may_hide || more_halvings == 0) return positive_share<2>({at_low, at_high});
  const Vec<Dim> middle = 0.5 * (low + high);
  const double at_middle = distance(middle);
  return 0.5 * (open_piece<Dim>(low, middle, at_low, at_middle, more_halvings - 1, distance) +
                open_piece<Dim>(middle, high, at_middle, at_high, more_halvings - 1, distance));
}

/// Share of a rectangle that lies where `distance` is positive.
/// \param along, across  its sides
/// \param around  distances of the corners low, low + along, low + along + across, low + across [m]
template <class Distance>
double open_piece(const Vec<3>& low, const Vec<3>& along, const Vec<3>& across, const std::array<double, 4>& around,
                  int more_halvings, const Distance& distance) {
  const bool is_outside = std::all_of(around.begin(), around.end(), [](double value) { return value > 0; });
  const double least = std::min(around[0] + around[2], around[1] + around[3]);
  if (!is_outside || more_halvings == 0 || least >= (along + across).norm()) {
    // Four triangles about the middle, so that no diagonal is preferred.
    const double middle = 0.25 * (around[0] + around[1] + around[2] + around[3]);
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += positive_share<3>({middle, around[k], around[(k + 1) % 4]});
    return 0.25 * sum;
  }
  const Vec<3> e = 0.5 * along;
  const Vec<3> f = 0.5 * across;
  const double below = distance(low + e);
  const double adjacent = distance(low + along + f);
  const double above = distance(low + e + across);
  const double before = distance(low + f);
  const double middle = distance(low + e + f);
  const int left = more_halvings - 1;
  return 0.25 * (open_piece(low, e, f, {around[0], below, middle, before}, left, distance) +
                 open_piece(low + e, e, f, {below, around[1], adjacent, middle}, left, distance) +
                 open_piece(low + e + f, e, f, {middle, adjacent, around[2], above}, left, distance) +
                 open_piece(low + f, e, f, {before, middle, above, around[3]}, left, distance));
}

/// Whether a segment with ends outside passes through something that is inside, as thin as it may be.
/// \param last  says so of the ends of the shortest pieces, if their distances do not
template <int Dim, class Distance, class Last>
bool passes_through(const Vec<Dim>& low, const Vec<Dim>& high, double at_low, double at_high, int more_halvings,
                    const Distance& distance, const Last& last) {
  if (at_low <= 0 || at_high <= 0) return true;
  if (at_low + at_high >= (high - low).norm()) return false;
  if (more_halvings == 0) return last(low, high);
  const Vec<Dim> middle = 0.5 * (low + high);
  const double at_middle = distance(middle);
  return passes_through<Dim>(low, middle, at_low, at_middle, more_halvings - 1, distance, last) ||
         passes_through<Dim>(middle, high, at_middle, at_high, more_halvings - 1, distance, last);
}

/// Share of a face of direction d that lies where `distance` is positive: a segment in 2-D, a rectangle in 3-D.
/// \param low, high  opposite corners, the same along d [m]
template <int Dim, class Distance>
double open_share(const Vec<Dim>& low, const Vec<Dim>& high, int d, const Distance& distance) {
  constexpr int n = clipped_pieces;
  const Vec<Dim> step = (high - low) / n;
  if constexpr (Dim == 2) {
    const int e = 1 - d;
    double sum = 0;
    double before = distance(low);
    for (int k = 1; k <= n; ++k) {
      Vec<2> x = low;
      x[e] += k * step[e];
      const double here = distance(x);
      sum += open_piece<2>(x - Vec<2>::Unit(e) * step[e], x, before, here, halvings<2>, distance);
      before = here;
    }
    return sum / n;
  } else {
    const int e = (d + 1) % 3;
    const int f = (d + 2) % 3;
    std::array<std::array<double, n + 1>, n + 1> at;
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Vec<3> x = low;
        x[e] += i * step[e];
        x[f] += j * step[f];
        at[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = distance(x);
      }
    }
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        Vec<3> x = low;
        x[e] += static_cast<double>(i) * step[e];
        x[f] += static_cast<double>(j) * step[f];
        sum += open_piece(x, step[e] * Vec<3>::Unit(e), step[f] * Vec<3>::Unit(f),
                          {at[j][i], at[j][i + 1], at[j + 1][i + 1], at[j + 1][i]}, halvings<3>, distance);
      }
    }
    return sum / (n * n);
  }
}

}  // namespace minamo
