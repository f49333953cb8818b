#pragma once
/// \file
/// Shapes made of others (constructive solid geometry).

#include "systems/shapes/shape.hpp"

namespace minamo::shapes {

/// What is in at least one of the shapes. The distance, the least of theirs, is Euclidean outside, provided that theirs
/// are; inside, where shapes overlap, it may be too small in magnitude, never too large.
/// Faces of the parts: those of the first shape, then those of the second, and so on; likewise of an intersection.
template <int Dim>
class Union : public Shape<Dim> {
 public:
  /// \pre there is at least one.
  explicit Union(std::vector<SharedShape<Dim>> shapes) : shapes_(std::move(shapes)) {}

  double distance(const Vec<Dim>& x) const override { return nearest(x).distance(x); }
  Vec<Dim> gradient(const Vec<Dim>& x) const override { return nearest(x).gradient(x); }
  bool contains(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override;
  bool is_bounded_by_distance() const override;
  std::optional<std::vector<ConvexPart<Dim>>> convex_parts() const override;

 private:
  const Shape<Dim>& nearest(const Vec<Dim>& x) const;

  std::vector<SharedShape<Dim>> shapes_;
};

/// What is in all of the shapes. The distance, the greatest of theirs, is Euclidean inside, provided that theirs are;
/// outside it may be too small, near edges where two surfaces meet, never too large.
template <int Dim>
class Intersection : public Shape<Dim> {
 public:
  /// \pre there is at least one.
  explicit Intersection(std::vector<SharedShape<Dim>> shapes) : shapes_(std::move(shapes)) {}

  double distance(const Vec<Dim>& x) const override { return farthest(x).distance(x); }
  Vec<Dim> gradient(const Vec<Dim>& x) const override { return farthest(x).gradient(x); }
  bool contains(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override;
  bool is_bounded_by_distance() const override;
  std::optional<std::vector<ConvexPart<Dim>>> convex_parts() const override;

 private:
  const Shape<Dim>& farthest(const Vec<Dim>& x) const;

  std::vector<SharedShape<Dim>> shapes_;
};

/// All that is not in a shape; its distance with the other sign.
template <int Dim>
class Complement : public Shape<Dim> {
 public:
  explicit Complement(SharedShape<Dim> shape) : shape_(std::move(shape)) {}

  double distance(const Vec<Dim>& x) const override { return -shape_->distance(x); }
  Vec<Dim> gradient(const Vec<Dim>& x) const override { return -shape_->gradient(x); }
  bool contains(const Vec<Dim>& x) const override { return shape_->distance(x) >= 0; }
  Bounds<Dim> bounds() const override { return {}; }
  bool is_bounded_by_distance() const override { return shape_->is_bounded_by_distance(); }
  std::optional<std::vector<ConvexPart<Dim>>> convex_parts() const override;

 private:
  SharedShape<Dim> shape_;
};

/// The first shape without the others: its intersection with their complements.
template <int Dim>
SharedShape<Dim> difference(const std::vector<SharedShape<Dim>>& shapes);

}  // namespace minamo::shapes
