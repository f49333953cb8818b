#pragma once
/// \file
/// Two components for the cases of this folder.

#include "engine/schedule/system.hpp"

namespace minamo {

struct Rows {
  static constexpr std::string_view name = "row";
};
struct Height : Column<Rows, double> {
  static constexpr ComponentInfo info{"row.height", "h", "m", Lifetime::state};
};
struct Total {
  double value = 0;
  static constexpr ComponentInfo info{"total", "T", "m", Lifetime::state};
};

}  // namespace minamo
