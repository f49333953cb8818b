#pragma once
/// \file
/// A signed distance sampled at the nodes of a grid: for shapes whose distance is slow, and for many questions.

#include "components/grid.hpp"
#include "systems/shapes/shape.hpp"

#include <vector>

namespace minamo {

/// Between the nodes the distance is bilinear (trilinear); outside of the grid it is that of the nearest point of the
/// grid, plus the distance from there, which has the right sign if the shape lies inside the grid.
/// Near a smooth surface the error is h^2/8 times the sum of its curvatures at most; edges are rounded within a cell.
template <int Dim>
class GridDistance : public Shape<Dim> {
 public:
  /// \param grid  low, spacing and cells count; not its periodic axes: all nodes from low to high get a value
  /// \param band  within this distance of the surface values are those of the shape; farther away they have its sign
  ///              and are bounds, at least `band` in magnitude: less than a tenth of the work where few cells are near.
  ///              Infinite, or for a shape that is not is_bounded_by_distance(): all values are the shape's. [m]
  /// Evaluated in parallel; the same bits on any number of threads.
  GridDistance(const Shape<Dim>& shape, const Grid<Dim>& grid, double band = std::numeric_limits<double>::infinity());

  double distance(const Vec<Dim>& x) const override;
  /// That of the interpolation: not of length 1 to the last digit. Outside of the grid by differences.
  Vec<Dim> gradient(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override { return bounds_; }
  bool is_bounded_by_distance() const override { return false; }

  /// At the nodes, x fastest. [m]
  const std::vector<double>& values() const { return values_; }

 private:
  void fill(const Shape<Dim>& shape, double band);

  Grid<Dim> grid_;
  Bounds<Dim> bounds_;
  std::vector<double> values_;
};

}  // namespace minamo
