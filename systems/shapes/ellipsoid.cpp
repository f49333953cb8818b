#include "systems/shapes/ellipsoid.hpp"

#include <algorithm>
#include <cmath>

namespace minamo::shapes {

namespace {

/// The point of an ellipsoid about the origin that is nearest to a point y >= 0. It is x_i = e_i^2 y_i / (e_i^2 + t),
/// with the largest t for which it lies on the ellipsoid; s = t + (least e)^2 here, which does not cancel.
template <int Dim>
class NearestOnEllipsoid {
 public:
  NearestOnEllipsoid(const Vec<Dim>& radii, const Vec<Dim>& y) : e_(radii), y_(y), least_(radii.minCoeff()) {
    for (int i = 0; i < Dim; ++i) beyond_[i] = (e_[i] - least_) * (e_[i] + least_);
  }

  Vec<Dim> point() const {
    const double s = root();
    return s > 0 ? place(s) : on_axis_plane();
  }

 private:
  Vec<Dim> place(double s) const {
    return e_.cwiseProduct(e_).cwiseProduct(y_).cwiseQuotient(beyond_ + Vec<Dim>::Constant(s));
  }

  /// F(s) = sum (x_i/e_i)^2 - 1, and its derivative. Decreasing and convex. Terms of y_i = 0 are zero for every s > 0.
  std::array<double, 2> excess(double s) const {
    std::array<double, 2> F{-1, 0};
    for (int i = 0; i < Dim; ++i) {
      if (y_[i] == 0) continue;
      const double ratio = e_[i] * y_[i] / (beyond_[i] + s);
      F[0] += ratio * ratio;
      F[1] -= 2 * ratio * ratio / (beyond_[i] + s);
    }
    return F;
  }

  /// s > 0, or 0 if y lies in the plane of the longer axes and the nearest point does not.
  double root() const {
    double low = 0;
    for (int i = 0; i < Dim; ++i) low = std::max(low, e_[i] * y_[i] - beyond_[i]);
    double high = e_.cwiseProduct(y_).stableNorm();
    if (!(high > 0) || (low == 0 && excess(0)[0] <= 0)) return 0;
    double s = low;
    for (int k = 0; k < 200; ++k) {
      const auto [F, slope] = excess(s);
      if (F == 0) break;
      (F > 0 ? low : high) = s;
      double next = s - F / slope;
      if (!(next > low && next < high)) next = low + (high - low) / 2;
      if (next == s || next == low || next == high) break;
      const bool converged = std::abs(next - s) <= 1e-16 * next;
      s = next;
      if (converged) break;
    }
    return s;
  }

  /// The limit s -> 0: what is left for the shortest axis, on which y is 0.
  Vec<Dim> on_axis_plane() const {
    Vec<Dim> x = Vec<Dim>::Zero();
    double left = 1;
    int shortest = 0;
    for (int i = 0; i < Dim; ++i) {
      if (beyond_[i] > 0) {
        x[i] = e_[i] * e_[i] * y_[i] / beyond_[i];
        left -= std::pow(x[i] / e_[i], 2);
      } else {
        shortest = i;
      }
    }
    x[shortest] = e_[shortest] * std::sqrt(std::max(0.0, left));
    return x;
  }

  Vec<Dim> e_;
  Vec<Dim> y_;
  double least_;
  Vec<Dim> beyond_;  ///< e_i^2 - (least e)^2
};

/// The nearest point to any y: it lies in the same orthant.
template <int Dim>
Vec<Dim> nearest_point(const Vec<Dim>& radii, const Vec<Dim>& y) {
  Vec<Dim> x = NearestOnEllipsoid<Dim>(radii, y.cwiseAbs()).point();
  for (int i = 0; i < Dim; ++i) {
    if (y[i] < 0) x[i] = -x[i];
  }
  return x;
}

}  // namespace

template <int Dim>
bool Ellipsoid<Dim>::contains(const Vec<Dim>& x) const {
  return local(x).cwiseQuotient(radii_).squaredNorm() <= 1;
}

template <int Dim>
double Ellipsoid<Dim>::distance(const Vec<Dim>& x) const {
  const Vec<Dim> y = local(x);
  const double distance = (y - nearest_point<Dim>(radii_, y)).norm();
  return contains(x) ? -distance : distance;
}

template <int Dim>
Vec<Dim> Ellipsoid<Dim>::gradient(const Vec<Dim>& x) const {
  const Vec<Dim> nearest = nearest_point<Dim>(radii_, local(x));
  return rotation_ * nearest.cwiseQuotient(radii_).cwiseQuotient(radii_).stableNormalized();
}

template <int Dim>
Bounds<Dim> Ellipsoid<Dim>::bounds() const {
  const Vec<Dim> half = (rotation_ * radii_.asDiagonal()).rowwise().norm();
  return {center_ - half, center_ + half};
}

template class Ellipsoid<2>;
template class Ellipsoid<3>;

}  // namespace minamo::shapes
