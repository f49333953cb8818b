#pragma once
/// \file
/// The largest and the smallest of numbers, of which a NaN cannot get lost.

#include <cmath>
#include <functional>
#include <limits>

namespace minamo {

/// std::max(worst, x) is `worst` if x is NaN: an error that is summed up so is small where all numbers are broken. This
/// is NaN from the first NaN on, and NaN if there was nothing to compare: no comparison with a limit holds then.
template <class Beats>
class Extreme {
 public:
  void add(double x) {
    if (is_empty_ || std::isnan(x) || Beats{}(x, value_)) value_ = x;  // nothing beats a NaN
    is_empty_ = false;
  }
  double value() const { return value_; }

 private:
  double value_ = std::numeric_limits<double>::quiet_NaN();
  bool is_empty_ = true;
};

/// The larger of a value so far and a number, and NaN from the first NaN on: where a sum of extremes has a start.
inline double largest_of(double so_far, double x) { return std::isnan(so_far) || x <= so_far ? so_far : x; }
inline double smallest_of(double so_far, double x) { return std::isnan(so_far) || x >= so_far ? so_far : x; }

using Largest = Extreme<std::greater<>>;
using Smallest = Extreme<std::less<>>;

}  // namespace minamo
