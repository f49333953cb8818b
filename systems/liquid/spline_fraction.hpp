#pragma once
/// \file
/// (E130) How much of the spline of a multiplier a plane leaves in the liquid, exactly, and where the plane is of which
/// that is known.

#include "systems/grid/splines.hpp"

namespace minamo {

/// Share of a multiplier's spline in the half space n.(x - x_l) + psi > 0.
template <int Dim>
class SplineFraction {
 public:
  /// \param n  unit normal into the liquid
  SplineFraction(const Splines<Dim>& splines, const Index<Dim>& site, const Vec<Dim>& n);

  struct Value {
    double share;  ///< [1]
    double slope;  ///< by psi
  };
  Value operator()(double psi) const;
  /// Mean over the spline of the depth below the plane, 0 above it, in units of h: the integral of the share over psi.
  double mean_depth(double psi) const;
  /// The distance psi of which the share is known, in units of h. \pre 0 < share < 1
  /// \param near  a first guess
  double inverse(double share, double near) const;

 private:
  /// Largest p for which an axis is asked: the mean depth begins at one, and axes before raise it by the degree each.
  static constexpr std::size_t largest_power(std::size_t axis) { return 1 + axis * largest_degree; }

  /// One axis: what it and those after it add to y = -n.(x - x_l).
  struct Axis {
    std::array<TruncatedPowers::Term, static_cast<std::size_t>(largest_degree + 1)> terms;  ///< of its own part of y
    std::size_t count = 0;
    double low = 0;   ///< least y of this axis and those after it
    double high = 0;  ///< largest
    std::array<double, std::tuple_size_v<decltype(TruncatedPowers::moments)>> moments{1};  ///< of (-y)^k/k!
  };
  static Axis axis_of(const TruncatedPowers& spline, double m);
  /// Adds what the axes after one add to y.
  static void join(Axis& axis, const Axis& others, std::size_t largest_power);
  /// Mean of (z - y)_+^p/p!, y of an axis and those after it, and its derivative by z.
  template <std::size_t A>
  Value mean_power(double z, int p) const;

  std::array<Axis, static_cast<std::size_t>(Dim)> axes_;  ///< of those along which the plane lies the rest is at y = 0
  double shift_ = 0;                                      ///< of psi, by axes along which the plane lies
};

}  // namespace minamo
