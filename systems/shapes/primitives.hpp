#pragma once
/// \file
/// Shapes with a formula for their distance.

#include "systems/shapes/shape.hpp"

namespace minamo::shapes {

/// A box, turned about its middle.
/// Faces: 2 d at the low end of its direction d, 2 d + 1 at the high end.
template <int Dim>
class Box : public Shape<Dim> {
 public:
  /// \pre low < high in every direction [m]; `rotation` orthogonal with determinant 1.
  Box(const Vec<Dim>& low, const Vec<Dim>& high, const Mat<Dim>& rotation = Mat<Dim>::Identity());

  double distance(const Vec<Dim>& x) const override;
  Vec<Dim> gradient(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override;
  std::optional<std::vector<ConvexPart<Dim>>> convex_parts() const override;

  Vec<Dim> size() const { return high_ - low_; }
  /// Where it is; of every direction 0 is its low end, 1 its high one. [m]
  Vec<Dim> corner(const Index<Dim>& ends) const;
  bool is_turned() const { return is_turned_; }

 private:
  Vec<Dim> local(const Vec<Dim>& x) const;
  /// Distance of a local point from the slab between two faces, per direction.
  Vec<Dim> from_slabs(const Vec<Dim>& local) const;

  Vec<Dim> low_;  ///< before it is turned
  Vec<Dim> high_;
  Vec<Dim> middle_;
  Mat<Dim> rotation_;
  bool is_turned_;
};

/// A disc or a ball.
template <int Dim>
class Ball : public Shape<Dim> {
 public:
  /// \pre radius > 0 [m]
  Ball(const Vec<Dim>& center, double radius) : center_(center), radius_(radius) {}

  double distance(const Vec<Dim>& x) const override { return (x - center_).norm() - radius_; }
  Vec<Dim> gradient(const Vec<Dim>& x) const override;
  bool contains(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override;

  const Vec<Dim>& center() const { return center_; }
  double radius() const { return radius_; }

 private:
  Vec<Dim> center_;
  double radius_;
};

/// All points within a radius of a line segment: a cylinder with round ends.
template <int Dim>
class Capsule : public Shape<Dim> {
 public:
  /// \pre from != to [m], radius > 0 [m]
  Capsule(const Vec<Dim>& from, const Vec<Dim>& to, double radius) : from_(from), along_(to - from), radius_(radius) {}

  double distance(const Vec<Dim>& x) const override { return from_segment(x).norm() - radius_; }
  Vec<Dim> gradient(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override;

 private:
  Vec<Dim> from_segment(const Vec<Dim>& x) const;

  Vec<Dim> from_;
  Vec<Dim> along_;
  double radius_;
};

/// A cylinder with flat ends.
class Cylinder : public Shape<3> {
 public:
  /// \pre from != to [m], radius > 0 [m]
  Cylinder(const Vec<3>& from, const Vec<3>& to, double radius);

  double distance(const Vec<3>& x) const override;
  Vec<3> gradient(const Vec<3>& x) const override;
  Bounds<3> bounds() const override;

 private:
  Vec<3> middle_;
  Vec<3> axis_;  ///< unit
  double half_;  ///< length
  double radius_;
};

/// Where the normal leaves: (x - point) . normal <= 0. Its only face is 0.
template <int Dim>
class HalfSpace : public Shape<Dim> {
 public:
  /// \pre normal != 0, of any length
  HalfSpace(const Vec<Dim>& point, const Vec<Dim>& normal) : point_(point), normal_(normal.stableNormalized()) {}

  double distance(const Vec<Dim>& x) const override { return (x - point_).dot(normal_); }
  Vec<Dim> gradient(const Vec<Dim>&) const override { return normal_; }
  Bounds<Dim> bounds() const override { return {}; }
  std::optional<std::vector<ConvexPart<Dim>>> convex_parts() const override;

 private:
  Vec<Dim> point_;
  Vec<Dim> normal_;
};

}  // namespace minamo::shapes
