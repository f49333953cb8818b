#pragma once
/// \file
/// (E130) How much of the spline of a multiplier a plane leaves in the liquid, exactly, and where the plane is of which
/// that is known.

#include "systems/conforming/splines.hpp"

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
  /// The distance psi of which the share is known, in units of h. \pre 0 < share < 1
  /// \param near  a first guess
  double inverse(double share, double near) const;

 private:
  struct Term {
    double at;
    double factor;
    int power;
  };
  static constexpr std::size_t most_terms = power(largest_degree + 1, Dim);
  std::array<Term, most_terms> terms_;
  std::size_t count_ = 1;
  double shift_ = 0;  ///< of psi, by axes along which the plane lies
  double low_ = 0;    ///< psi of share 0
  double high_ = 0;   ///< psi of share 1
};

}  // namespace minamo
