#pragma once
/// \file
/// What a closed line or a closed mesh must be.

#include "systems/shapes/outline.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>

namespace minamo {

/// Area or volume within; negative if it is turned inside out.
inline double enclosed(const Outline<2>& outline) {
  double twice = 0;
  for (const auto& [a, b] : outline.element)
    twice += outline.point[a][0] * outline.point[b][1] - outline.point[a][1] * outline.point[b][0];
  return twice / 2;
}
inline double enclosed(const Outline<3>& outline) {
  double six = 0;
  for (const auto& [a, b, c] : outline.element) six += outline.point[a].dot(outline.point[b].cross(outline.point[c]));
  return six / 6;
}

/// Every point begins as many segments as it ends.
inline bool is_closed(const Outline<2>& outline) {
  std::vector<int> begun(outline.point.size(), 0);
  std::vector<int> ended(outline.point.size(), 0);
  for (const auto& [a, b] : outline.element) {
    ++begun[a];
    ++ended[b];
  }
  const std::vector<int> once(outline.point.size(), 1);
  return !outline.element.empty() && begun == once && ended == once;
}
/// Every edge is passed once in each direction.
inline bool is_closed(const Outline<3>& outline) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> passed;
  for (const auto& corner : outline.element) {
    for (std::size_t k = 0; k < 3; ++k) ++passed[{corner[k], corner[(k + 1) % 3]}];
  }
  return !passed.empty() && std::all_of(passed.begin(), passed.end(), [&](const auto& edge) {
    const auto back = passed.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != passed.end() && back->second == 1;
  });
}

/// Points less edges plus triangles: 2 per ball in 3-D; 0 of closed lines.
inline long euler_number(const Outline<2>& outline) {
  return static_cast<long>(outline.point.size()) - static_cast<long>(outline.element.size());
}
inline long euler_number(const Outline<3>& outline) {
  const auto edges = 3 * outline.element.size() / 2;
  return static_cast<long>(outline.point.size()) - static_cast<long>(edges) + static_cast<long>(outline.element.size());
}

}  // namespace minamo
