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

/// 1/k, up to the largest power, of the mean depth in 3-D.
constexpr auto inverse_of = [] {
  std::array<double, static_cast<std::size_t>(3 * largest_degree + 2)> inverse{};
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

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
  std::size_t a = 0;
  for (const std::size_t d : order) {
    const TruncatedPowers& along = splines.axis[d].powers_of_multiplier(site[d]);
    const double m = -n[static_cast<Eigen::Index>(d)];
    if (std::abs(m) < along_plane) {
      shift_ -= m * along.moments[1];
    } else {
      axes_[a++] = axis_of(along, m);
    }
  }
  for (a = axes_.size() - 1; a-- > 0;) join(axes_[a], axes_[a + 1], largest_power(a));
}

template <int Dim>
typename SplineFraction<Dim>::Axis SplineFraction<Dim>::axis_of(const TruncatedPowers& spline, double m) {
  Axis axis;
  axis.count = spline.count;
  axis.low = std::numeric_limits<double>::infinity();
  axis.high = -axis.low;
  const double inverse = 1 / std::abs(m);
  for (std::size_t t = 0; t < spline.count; ++t) {
    const TruncatedPowers::Term& term = spline.terms[t];
    double jump = m > 0 || term.power % 2 != 0 ? term.jump : -term.jump;
    for (int k = 0; k <= term.power; ++k) jump *= inverse;
    axis.terms[t] = {m * term.at, jump, term.power + 1};
    axis.low = std::min(axis.low, m * term.at);
    axis.high = std::max(axis.high, m * term.at);
  }
  double power = 1;
  for (std::size_t k = 0; k < spline.moments.size(); ++k, power *= -m) axis.moments[k] = power * spline.moments[k];
  return axis;
}

template <int Dim>
void SplineFraction<Dim>::join(Axis& axis, const Axis& others, std::size_t largest_power) {
  axis.low += others.low;
  axis.high += others.high;
  for (std::size_t k = largest_power + 1; k-- > 0;) {
    double sum = 0;
    for (std::size_t j = 0; j <= k; ++j) sum += axis.moments[j] * others.moments[k - j];
    axis.moments[k] = sum;
  }
}

template <int Dim>
template <std::size_t A>
typename SplineFraction<Dim>::Value SplineFraction<Dim>::mean_power(double z, int p) const {
  const Axis& axis = axes_[A];
  if (z <= axis.low) return {0, 0};
  Value sum{0, 0};
  if (z >= axis.high) {
    double power = 1;  // z^k/k!
    for (int k = 0; k < p; ++k) {
      sum.share += power * axis.moments[static_cast<std::size_t>(p - k)];
      sum.slope += power * axis.moments[static_cast<std::size_t>(p - 1 - k)];
      power *= z * inverse_of[static_cast<std::size_t>(k + 1)];
    }
    sum.share += power * axis.moments[0];
    return sum;
  }
  for (std::size_t t = 0; t < axis.count; ++t) {
    const TruncatedPowers::Term& term = axis.terms[t];
    const double rest = z - term.at;
    Value of_others{0, 0};
    if constexpr (A + 1 < Dim) {
      of_others = mean_power<A + 1>(rest, p + term.power);
    } else if (rest > 0) {
      of_others.slope = 1;
      for (int k = 1; k < p + term.power; ++k) of_others.slope *= rest * inverse_of[static_cast<std::size_t>(k)];
      of_others.share = of_others.slope * rest * inverse_of[static_cast<std::size_t>(p + term.power)];
    }
    sum.share += term.jump * of_others.share;
    sum.slope += term.jump * of_others.slope;
  }
  return sum;
}

template <int Dim>
typename SplineFraction<Dim>::Value SplineFraction<Dim>::operator()(double psi) const {
  return mean_power<0>(psi + shift_, 0);
}

template <int Dim>
double SplineFraction<Dim>::mean_depth(double psi) const {
  return mean_power<0>(psi + shift_, 1).share;
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
