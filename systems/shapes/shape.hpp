#pragma once
/// \file
/// A region of space by its signed distance: of liquid, or a solid body.

#include "components/types.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace minamo {

/// The half space normal . x <= offset.
template <int Dim>
struct Facet {
  static constexpr int inner = -1;

  Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, out of the half space [1]
  double offset = 0;                   ///< [m]
  int face = inner;                    ///< of the shape; `inner`: a cut between two parts of the shape
};

/// Where all of its facets' half spaces are.
template <int Dim>
using ConvexPart = std::vector<Facet<Dim>>;

/// Immutable. All members may be called from several threads at once.
template <int Dim>
class Shape {
 public:
  Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;
  virtual ~Shape() = default;

  /// Negative inside, positive outside. The Euclidean distance to the surface, unless the shape says otherwise. [m]
  virtual double distance(const Vec<Dim>& x) const = 0;

  /// Gradient of the distance, out of the shape: the unit normal at the nearest point of the surface where the distance
  /// is Euclidean; one of the normals where several points are nearest. [1]
  /// Unless the shape knows better: central differences over 1e-6 of the largest coordinate or of the distance.
  virtual Vec<Dim> gradient(const Vec<Dim>& x) const;

  /// Whether a point lies inside or on the surface, to the last bit.
  virtual bool contains(const Vec<Dim>& x) const { return distance(x) <= 0; }

  /// A box that the shape lies in; infinite where the shape is.
  virtual Bounds<Dim> bounds() const = 0;

  /// Whether |distance(x) - distance(y)| <= |x - y|, so that one distance tells of a neighbourhood.
  virtual bool is_bounded_by_distance() const { return true; }

  /// Convex parts with plane facets whose union is the shape; they may overlap. None if the shape is curved, or it
  /// would take more than `most_parts`.
  virtual std::optional<std::vector<ConvexPart<Dim>>> convex_parts() const { return {}; }
  static constexpr std::size_t most_parts = 10'000;
};

template <int Dim>
using SharedShape = std::shared_ptr<const Shape<Dim>>;

}  // namespace minamo
