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

/// Share of a face of direction d that lies where `distance` is positive: a segment in the plane, a rectangle in space.
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
      sum += positive_share<2>({before, here});
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
        // Four triangles about the middle, so that no diagonal is preferred.
        const std::array<double, 4> around{at[j][i], at[j][i + 1], at[j + 1][i + 1], at[j + 1][i]};
        const double middle = 0.25 * (around[0] + around[1] + around[2] + around[3]);
        for (std::size_t k = 0; k < 4; ++k) sum += positive_share<3>({middle, around[k], around[(k + 1) % 4]});
      }
    }
    return sum / (4 * n * n);
  }
}

}  // namespace minamo
