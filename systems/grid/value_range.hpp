#pragma once
/// \file
/// The range of the values that another one is made of.

#include <algorithm>
#include <limits>

namespace minamo {

struct ValueRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void cover(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double width() const { return most - least; }
  /// The value nearest to `value` that lies no farther outside than `beyond`; NaN stays NaN. Not std::clamp, which is
  /// undefined for the limits of an empty range.
  double limit(double value, double beyond) const { return std::min(std::max(value, least - beyond), most + beyond); }
};

}  // namespace minamo
