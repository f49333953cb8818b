#include "systems/liquid/spline_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace minamo {

namespace {

/// |n_d| that is taken for zero: the plane lies along the axis.
constexpr double along_plane = 1e-9;
/// Of the share, before the last step of Newton's method, which leaves its square.
constexpr double tolerance = 1e-9;
constexpr int most_iterations = 60;

double power_of(double base, int exponent) {
  double product = 1;
  for (int k = 0; k < exponent; ++k) product *= base;
  return product;
}

}  // namespace

// The share is the mean of (psi - y)_+^0, y = -n.(x - x_l), x_d distributed as the spline of axis d is, a sum of
// truncated powers. Such a power of one axis raises that of the mean over the others:
// int (y' - a)_+^q/q! (z - y' - y)_+^p/p! dy' = (z - a - y)_+^(p + q + 1)/(p + q + 1)!.
// Past all of y the mean is a polynomial, by moments of y: as the difference of powers it would lose digits, the more
// the smaller the part of an axis in y. Axes with larger parts therefore come first.
template <int Dim>
SplineFraction<Dim>::SplineFraction(const Splines<Dim>& splines, const Index<Dim>& site, const Vec<Dim>& n) {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto part = [&](std::size_t d) { return std::abs(n[static_cast<Eigen::Index>(d)]); };
  std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) { return part(one) > part(other); });
  for (const std::size_t d : order) {
    const TruncatedPowers& along = splines.axis[d].powers_of_multiplier(site[d]);
    const double m = -n[static_cast<Eigen::Index>(d)];
    if (std::abs(m) < along_plane) {
      shift_ -= m * along.moments[1];
      continue;
    }
    Axis& axis = axes_[count_++];
    axis.count = along.count;
    axis.low = std::numeric_limits<double>::infinity();
    axis.high = -axis.low;
    for (std::size_t t = 0; t < along.count; ++t) {
      const TruncatedPowers::Term& term = along.terms[t];
      const double sign = m > 0 || term.power % 2 != 0 ? 1 : -1;
      axis.terms[t] = {m * term.at, sign * term.jump / power_of(std::abs(m), term.power + 1), term.power + 1};
      axis.low = std::min(axis.low, m * term.at);
      axis.high = std::max(axis.high, m * term.at);
    }
    for (std::size_t k = 0; k < along.moments.size(); ++k)
      axis.moments[k] = along.moments[k] * power_of(-m, static_cast<int>(k));
  }
  for (std::size_t a = count_; a-- > 1;) {
    Axis& axis = axes_[a - 1];
    const Axis& others = axes_[a];
    axis.low += others.low;
    axis.high += others.high;
    for (std::size_t k = axis.moments.size(); k-- > 0;) {
      double sum = 0;
      for (std::size_t j = 0; j <= k; ++j) sum += axis.moments[j] * others.moments[k - j];
      axis.moments[k] = sum;
    }
  }
}

template <int Dim>
typename SplineFraction<Dim>::Value SplineFraction<Dim>::mean_power(std::size_t a, double z, int p) const {
  const bool is_last = a == count_;
  if (z <= (is_last ? 0 : axes_[a].low)) return {0, 0};
  if (is_last || z >= axes_[a].high) {
    Value sum{0, 0};
    double power = 1;  // z^k/k!
    for (int k = 0; k <= p; ++k) {
      const auto moment = [&](int order) {
        return is_last ? (order == 0 ? 1.0 : 0.0) : axes_[a].moments[static_cast<std::size_t>(order)];
      };
      sum.share += power * moment(p - k);
      if (k < p) sum.slope += power * moment(p - 1 - k);
      power *= z / (k + 1);
    }
    return sum;
  }
  Value sum{0, 0};
  const Axis& axis = axes_[a];
  for (std::size_t t = 0; t < axis.count; ++t) {
    const TruncatedPowers::Term& term = axis.terms[t];
    const Value of_others = mean_power(a + 1, z - term.at, p + term.power);
    sum.share += term.jump * of_others.share;
    sum.slope += term.jump * of_others.slope;
  }
  return sum;
}

// Newton's method, kept within what is known of the root.
template <int Dim>
double SplineFraction<Dim>::inverse(double share, double near) const {
  double low = axes_[0].low - shift_;
  double high = axes_[0].high - shift_;
  double psi = std::clamp(near, low, high);
  for (int k = 0; k < most_iterations; ++k) {
    const Value value = (*this)(psi);
    const double excess = value.share - share;
    (excess > 0 ? high : low) = psi;
    const double next = value.slope > 0 ? psi - excess / value.slope : low - 1;
    psi = next >= low && next <= high ? next : 0.5 * (low + high);
    if (std::abs(excess) < tolerance) break;
  }
  return psi;
}

template class SplineFraction<2>;
template class SplineFraction<3>;

}  // namespace minamo
