#pragma once
/// \file
/// Two tables and columns of one of them, for tests of the engine.

#include "engine/schedule/system.hpp"

#include <algorithm>
#include <vector>

namespace minamo::rows {

struct Rows {
  static constexpr std::string_view name = "row";
};
struct OtherRows {
  static constexpr std::string_view name = "other";
};
struct Height : Column<Rows, double> {
  static constexpr ComponentInfo info{"row.height", "h", "m", Lifetime::state};
};
struct Slope : Column<Rows, double> {
  static constexpr ComponentInfo info{"row.slope", "s", "1", Lifetime::scratch};
};
struct Depth : Column<OtherRows, double> {
  static constexpr ComponentInfo info{"other.depth", "d", "m", Lifetime::scratch};
};

inline World world_with_heights(const std::vector<double>& heights) {
  World world;
  world.resize<Rows>(heights.size());
  std::copy(heights.begin(), heights.end(), world.column<Height>().begin());
  return world;
}

template <class Span>
std::vector<double> values(const Span& span) {
  return {span.begin(), span.end()};
}

}  // namespace minamo::rows
