#pragma once
/// \file
/// An ellipse or an ellipsoid.

#include "systems/shapes/shape.hpp"

namespace minamo::shapes {

template <int Dim>
class Ellipsoid : public Shape<Dim> {
 public:
  /// \param radii     along its axes, > 0 [m]
  /// \param rotation  its columns are the axes; orthogonal with determinant 1
  Ellipsoid(const Vec<Dim>& center, const Vec<Dim>& radii, const Mat<Dim>& rotation = Mat<Dim>::Identity())
      : center_(center), radii_(radii), rotation_(rotation) {}

  /// The Euclidean distance, by iteration (Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a
  /// Hyperellipsoid, 2013).
  double distance(const Vec<Dim>& x) const override;
  Vec<Dim> gradient(const Vec<Dim>& x) const override;
  bool contains(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override;

 private:
  Vec<Dim> local(const Vec<Dim>& x) const { return rotation_.transpose() * (x - center_); }

  Vec<Dim> center_;
  Vec<Dim> radii_;
  Mat<Dim> rotation_;
};

}  // namespace minamo::shapes
