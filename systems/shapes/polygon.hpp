#pragma once
/// \file
/// A simple polygon in 2-D.

#include "systems/shapes/shape.hpp"

#include <array>
#include <span>
#include <string>

namespace minamo::shapes {

/// Face k goes from corner k to the next one, in the order in which they were given.
class Polygon : public Shape<2> {
 public:
  /// \pre what_is_wrong(corners) finds nothing. In either direction. [m]
  explicit Polygon(std::vector<Vec<2>> corners);

  double distance(const Vec<2>& x) const override;
  Vec<2> gradient(const Vec<2>& x) const override;
  /// By the number of sides that a ray crosses; points of the boundary may count as outside by a rounding.
  bool contains(const Vec<2>& x) const override;
  Bounds<2> bounds() const override;
  /// Triangles, by cutting off ears (Meisters, Polygons Have Ears, 1975).
  std::optional<std::vector<ConvexPart<2>>> convex_parts() const override;

  /// Counterclockwise. [m]
  const std::vector<Vec<2>>& corners() const { return corners_; }

 private:
  std::vector<Vec<2>> corners_;  ///< counterclockwise
  bool is_reversed_;             ///< against the order in which they were given
};

/// Why corners make no polygon. Empty: they do.
struct PolygonProblem {
  std::string what;
  std::string where;
};
std::optional<PolygonProblem> what_is_wrong(std::span<const Vec<2>> corners);

}  // namespace minamo::shapes
