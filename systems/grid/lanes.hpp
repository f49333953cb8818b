#pragma once
/// \file
/// Particles side by side, one in every lane of a register, so that a kernel does for four of them at
/// once what it would do for one. A group that is not full has the last particle in the lanes left over.

#include "systems/grid/site_support.hpp"

#include <span>

namespace minamo {

inline constexpr std::size_t lanes = 4;

inline constexpr Four of_lane{0, 1, 2, 3};  ///< the number of every lane

/// Up to four particles, one behind the other.
struct Group {
  std::size_t first;
  std::size_t count;
  std::size_t particle(std::size_t lane) const { return first + (lane < count ? lane : count - 1); }
};

/// Calls body(group) for the particles of a cell, in their order.
template <class Cell, class Body>
[[gnu::always_inline]] inline void for_each_group(const Cell& cell, const Body& body) {
  for (std::size_t p = cell.begin; p < cell.end; p += lanes) body(Group{p, std::min<std::size_t>(lanes, cell.end - p)});
}

/// Calls body(lane, particle) for the lanes in use.
template <class Body>
[[gnu::always_inline]] inline void for_each_lane(const Group& group, const Body& body) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (lane < group.count) body(lane, group.first + lane);
  }
}

/// of(particle) of every lane.
template <class Of>
[[gnu::always_inline]] inline Four of_group(const Group& group, const Of& of) {
  return Four{of(group.particle(0)), of(group.particle(1)), of(group.particle(2)), of(group.particle(3))};
}

/// Numbers of the lanes, zero in those that the group does not use.
[[gnu::always_inline]] inline Four unused_are_zero(const Group& group, const Four& of) {
  return of_lane >= static_cast<double>(group.count) ? Four{} : of;
}

/// Places within a cell, in units of h.
template <int Dim>
using LanePlace = std::array<Four, static_cast<std::size_t>(Dim)>;

/// CellFrame::local() of every lane, to the last digit.
template <int Dim>
[[gnu::always_inline]] inline LanePlace<Dim> local(const CellFrame<Dim>& frame, std::span<const Vec<Dim>> y_p,
                                                   const Group& group) {
  LanePlace<Dim> place;
  for (int d = 0; d < Dim; ++d) {
    Four xi = (of_group(group, [&](std::size_t p) { return y_p[p][d]; }) - frame.low[d]) * frame.per_spacing;
    xi = xi < -0.5 ? xi + frame.period[d] : xi;
    xi = xi > 1.5 ? xi - frame.period[d] : xi;
    xi = xi < 0.0 ? Four{} : xi;
    xi = xi > 1.0 ? Four{1, 1, 1, 1} : xi;
    place[static_cast<std::size_t>(d)] = xi;
  }
  return place;
}

/// The vector in a lane.
template <std::size_t Dim>
[[gnu::always_inline]] inline Vec<static_cast<int>(Dim)> in_lane(const std::array<Four, Dim>& of, std::size_t lane) {
  Vec<static_cast<int>(Dim)> vector;
  for (std::size_t d = 0; d < Dim; ++d) vector[static_cast<Eigen::Index>(d)] = of[d][lane];
  return vector;
}

/// The numbers of every lane as a vector: lane k of vector j is lane j of vector k.
[[gnu::always_inline]] inline std::array<Four, lanes> transposed(const std::array<Four, lanes>& of) {
  const Four even_low = __builtin_shufflevector(of[0], of[1], 0, 4, 2, 6);
  const Four odd_low = __builtin_shufflevector(of[0], of[1], 1, 5, 3, 7);
  const Four even_high = __builtin_shufflevector(of[2], of[3], 0, 4, 2, 6);
  const Four odd_high = __builtin_shufflevector(of[2], of[3], 1, 5, 3, 7);
  return {
      __builtin_shufflevector(even_low, even_high, 0, 1, 4, 5), __builtin_shufflevector(odd_low, odd_high, 0, 1, 4, 5),
      __builtin_shufflevector(even_low, even_high, 2, 3, 6, 7), __builtin_shufflevector(odd_low, odd_high, 2, 3, 6, 7)};
}

/// Sum over the lanes, always in the same order.
[[gnu::always_inline]] inline double sum_of_lanes(const Four& of) { return (of[0] + of[1]) + (of[2] + of[3]); }

}  // namespace minamo
