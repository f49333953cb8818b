#include "systems/liquid/spline_fraction.hpp"

#include <cmath>

namespace minamo {

namespace {

/// A plane along an axis cuts all of it alike. Nearer to it, powers of 1/|n_d| would lose digits.
constexpr double along_plane = 4e-3;
constexpr double tolerance = 1e-9;
constexpr int most_iterations = 60;

double power_of(double base, int exponent) {
  double product = base;
  for (int k = 1; k < exponent; ++k) product *= base;
  return product;
}

}  // namespace

// The share is the probability that y = -sum_d n_d (x_d - x_ld) is less than psi, x_d distributed as the spline of axis
// d is. Densities of n x are truncated powers if those of x are, and a convolution adds their places and their powers:
// (y - a)_+^p/p! * (y - b)_+^q/q! = (y - a - b)_+^{p + q + 1}/(p + q + 1)!.
template <int Dim>
SplineFraction<Dim>::SplineFraction(const Splines<Dim>& splines, const Index<Dim>& site, const Vec<Dim>& n) {
  terms_[0] = {0, 1, 0};
  for (std::size_t d = 0; d < Dim; ++d) {
    const TruncatedPowers& along = splines.axis[d].powers_of_multiplier(site[d]);
    const double m = -n[static_cast<Eigen::Index>(d)];
    if (std::abs(m) < along_plane) {
      shift_ -= m * along.mean;
      continue;
    }
    const double scale = std::abs(m);
    const std::size_t before = count_;
    std::array<Term, static_cast<std::size_t>(largest_degree + 1)> of_axis;
    double least = along.terms[0].at;
    double most = along.terms[0].at;
    for (std::size_t t = 0; t < along.count; ++t) {
      const TruncatedPowers::Term& term = along.terms[t];
      const double mirrored = term.power % 2 == 0 ? -1 : 1;
      of_axis[t] = {m * term.at, (m > 0 ? 1 : mirrored) * term.jump / power_of(scale, term.power + 1), term.power + 1};
      least = std::min(least, term.at);
      most = std::max(most, term.at);
    }
    low_ += m > 0 ? m * least : m * most;
    high_ += m > 0 ? m * most : m * least;
    count_ = before * along.count;
    for (std::size_t k = before; k-- > 0;) {
      const Term one = terms_[k];
      for (std::size_t t = along.count; t-- > 0;) {
        terms_[k * along.count + t] = {one.at + of_axis[t].at, one.factor * of_axis[t].factor,
                                       one.power + of_axis[t].power};
      }
    }
  }
}

template <int Dim>
typename SplineFraction<Dim>::Value SplineFraction<Dim>::operator()(double psi) const {
  const double y = psi + shift_;
  if (y <= low_) return {0, 0};
  if (y >= high_) return {1, 0};
  Value sum{0, 0};
  for (std::size_t k = 0; k < count_; ++k) {
    const Term& term = terms_[k];
    const double above = y - term.at;
    if (above <= 0) continue;
    double slope = term.factor;
    for (int p = 1; p < term.power; ++p) slope *= above / p;
    sum.slope += slope;
    sum.share += slope * above / term.power;
  }
  return sum;
}

// Newton's method, kept within what is known of the root.
template <int Dim>
double SplineFraction<Dim>::inverse(double share, double near) const {
  double low = low_ - shift_;
  double high = high_ - shift_;
  double psi = std::clamp(near, low, high);
  for (int k = 0; k < most_iterations; ++k) {
    const Value value = (*this)(psi);
    const double excess = value.share - share;
    if (std::abs(excess) < tolerance) break;
    (excess > 0 ? high : low) = psi;
    const double next = value.slope > 0 ? psi - excess / value.slope : low - 1;
    psi = next > low && next < high ? next : 0.5 * (low + high);
  }
  return psi;
}

template class SplineFraction<2>;
template class SplineFraction<3>;

}  // namespace minamo
