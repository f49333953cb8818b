#include "systems/shapes/primitives.hpp"

#include <algorithm>
#include <cmath>

namespace minamo::shapes {

namespace {

/// Unit vector along v; the fallback for zero.
template <int Dim>
Vec<Dim> direction(const Vec<Dim>& v, const Vec<Dim>& fallback) {
  return v.isZero(0) ? fallback : Vec<Dim>(v.stableNormalized());
}

/// Any unit vector at a right angle.
template <int Dim>
Vec<Dim> across(const Vec<Dim>& v) {
  if constexpr (Dim == 2) return Vec<2>(-v[1], v[0]).stableNormalized();
  Eigen::Index least = 0;
  v.cwiseAbs().minCoeff(&least);
  const Vec<Dim> unit = Vec<Dim>::Unit(least);
  return (unit - unit.dot(v) / v.squaredNorm() * v).stableNormalized();
}

/// The distance from an intersection of slabs at right angles, of the distances from each.
template <class Slabs>
double combined(const Slabs& slabs) {
  const double largest = slabs.maxCoeff();
  return largest > 0 ? slabs.cwiseMax(0).stableNorm() : largest;
}

}  // namespace

template <int Dim>
Box<Dim>::Box(const Vec<Dim>& low, const Vec<Dim>& high, const Mat<Dim>& rotation)
    : low_(low),
      high_(high),
      middle_((low + high) / 2),
      rotation_(rotation),
      is_turned_(rotation != Mat<Dim>::Identity()) {}

template <int Dim>
Vec<Dim> Box<Dim>::local(const Vec<Dim>& x) const {
  if (!is_turned_) return x;  // to the bit, so that points on a face are inside
  return middle_ + rotation_.transpose() * (x - middle_);
}

template <int Dim>
Vec<Dim> Box<Dim>::from_slabs(const Vec<Dim>& local) const {
  return (low_ - local).cwiseMax(local - high_);
}

template <int Dim>
double Box<Dim>::distance(const Vec<Dim>& x) const {
  return combined(from_slabs(local(x)));
}

template <int Dim>
Vec<Dim> Box<Dim>::gradient(const Vec<Dim>& x) const {
  const Vec<Dim> at = local(x);
  const Vec<Dim> slabs = from_slabs(at);
  Eigen::Index farthest = 0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
  if (slabs.maxCoeff(&farthest) > 0)
    gradient = slabs.cwiseMax(0).stableNormalized();
  else
    gradient[farthest] = 1;
  for (int d = 0; d < Dim; ++d) {
    if (at[d] < middle_[d]) gradient[d] = -gradient[d];
  }
  return rotation_ * gradient;
}

template <int Dim>
Bounds<Dim> Box<Dim>::bounds() const {
  if (!is_turned_) return {low_, high_};
  const Vec<Dim> half = rotation_.cwiseAbs() * ((high_ - low_) / 2);
  return {middle_ - half, middle_ + half};
}

template <int Dim>
Vec<Dim> Box<Dim>::corner(const Index<Dim>& ends) const {
  Vec<Dim> at = low_;
  for (int d = 0; d < Dim; ++d) {
    if (ends[static_cast<std::size_t>(d)] == 1) at[d] = high_[d];
  }
  return is_turned_ ? Vec<Dim>(middle_ + rotation_ * (at - middle_)) : at;
}

template <int Dim>
std::optional<std::vector<ConvexPart<Dim>>> Box<Dim>::convex_parts() const {
  ConvexPart<Dim> part;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> normal = rotation_.col(d);
    const double at_middle = normal.dot(middle_);
    part.push_back({-normal, (middle_[d] - low_[d]) - at_middle, 2 * d});
    part.push_back({normal, (high_[d] - middle_[d]) + at_middle, 2 * d + 1});
  }
  return {{part}};
}

template <int Dim>
Vec<Dim> Ball<Dim>::gradient(const Vec<Dim>& x) const {
  return direction<Dim>(x - center_, Vec<Dim>::Unit(0));
}

template <int Dim>
bool Ball<Dim>::contains(const Vec<Dim>& x) const {
  double squared = 0;
  for (int d = 0; d < Dim; ++d) squared += std::pow(x[d] - center_[d], 2);
  return squared <= radius_ * radius_;
}

template <int Dim>
Bounds<Dim> Ball<Dim>::bounds() const {
  const Vec<Dim> radius = Vec<Dim>::Constant(radius_);
  return {center_ - radius, center_ + radius};
}

template <int Dim>
Vec<Dim> Capsule<Dim>::from_segment(const Vec<Dim>& x) const {
  const Vec<Dim> from = x - from_;
  return from - std::clamp(from.dot(along_) / along_.squaredNorm(), 0.0, 1.0) * along_;
}

template <int Dim>
Vec<Dim> Capsule<Dim>::gradient(const Vec<Dim>& x) const {
  return direction<Dim>(from_segment(x), across<Dim>(along_));
}

template <int Dim>
Bounds<Dim> Capsule<Dim>::bounds() const {
  const Vec<Dim> radius = Vec<Dim>::Constant(radius_);
  const Vec<Dim> to = from_ + along_;
  return {from_.cwiseMin(to) - radius, from_.cwiseMax(to) + radius};
}

Cylinder::Cylinder(const Vec<3>& from, const Vec<3>& to, double radius)
    : middle_((from + to) / 2),
      axis_((to - from).stableNormalized()),
      half_((to - from).stableNorm() / 2),
      radius_(radius) {}

double Cylinder::distance(const Vec<3>& x) const {
  const Vec<3> from_middle = x - middle_;
  const double along = from_middle.dot(axis_);
  const double radial = (from_middle - along * axis_).norm();
  return combined(Vec<2>(std::abs(along) - half_, radial - radius_));
}

Vec<3> Cylinder::gradient(const Vec<3>& x) const {
  const Vec<3> from_middle = x - middle_;
  const double along = from_middle.dot(axis_);
  const Vec<3> radial = from_middle - along * axis_;
  const Vec<3> to_end = along < 0 ? Vec<3>(-axis_) : axis_;
  const Vec<3> to_side = direction<3>(radial, across<3>(axis_));
  const double beyond_end = std::abs(along) - half_;
  const double beyond_side = radial.norm() - radius_;
  if (beyond_end > 0 && beyond_side > 0) return (beyond_end * to_end + beyond_side * to_side).stableNormalized();
  return beyond_end > beyond_side ? to_end : to_side;
}

Bounds<3> Cylinder::bounds() const {
  // A disc with normal e reaches sqrt(1 - e_d^2) of its radius along direction d.
  Vec<3> half;
  for (int d = 0; d < 3; ++d)
    half[d] = half_ * std::abs(axis_[d]) + radius_ * std::sqrt(std::max(0.0, 1 - axis_[d] * axis_[d]));
  return {middle_ - half, middle_ + half};
}

template <int Dim>
std::optional<std::vector<ConvexPart<Dim>>> HalfSpace<Dim>::convex_parts() const {
  return {{ConvexPart<Dim>{Facet<Dim>{normal_, normal_.dot(point_), 0}}}};
}

template class Box<2>;
template class Box<3>;
template class Ball<2>;
template class Ball<3>;
template class Capsule<2>;
template class Capsule<3>;
template class HalfSpace<2>;
template class HalfSpace<3>;

}  // namespace minamo::shapes
