#pragma once
/// \file
/// The sites around points that are no particles, and their splines there.

#include "systems/grid/site_support.hpp"

namespace minamo {

/// Calls body(k, offset) for the 3^d quadratic splines of a cell, k their place among its sites.
template <int Dim, int K, class Body>
void for_each_quadratic(const Body& body) {
  for_each_offset<Dim, K, 3, 3, 3>(body);
}

/// The quadratic spline of a site at a point: those of velocities along themselves for degree 2, across for degree 3.
template <int Dim, int K>
double quadratic_weight(const SplineWeights<Dim, K>& weights, const Index<Dim>& offset) {
  double product = 1;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto a = static_cast<std::size_t>(offset[d]);
    if constexpr (K == 2) {
      product *= weights.along[d][a];
    } else {
      product *= weights.across[d][a];
    }
  }
  return product;
}

/// Of one point after the other: rows are looked up anew where the cell is another.
template <int Dim, int K>
class PointSites {
 public:
  PointSites(const Grid<Dim>& grid, const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows)
      : grid_(grid), splines_(splines), rows_(rows) {}

  SplineWeights<Dim, K> weights_at(const Vec<Dim>& x) {
    const Index<Dim> cell = cell_around<Dim>(grid_, splines_, x);
    if (!is_found_ || cell != cell_) find(cell);
    const CellFrame<Dim> frame(grid_, splines_, cell);
    return {frame, frame.local(x)};
  }
  /// That of the last point.
  const Index<Dim>& cell() const { return cell_; }
  /// Row of site k of the cell of the last point, or none.
  std::int32_t row(std::size_t k) const { return row_[k]; }

 private:
  void find(const Index<Dim>& cell) {
    for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
      const auto found = rows_.find(splines_.site(cell, offset));
      row_[k] = found ? static_cast<std::int32_t>(*found) : staggered::none;
    });
    cell_ = cell;
    is_found_ = true;
  }

  const Grid<Dim>& grid_;
  const Splines<Dim>& splines_;
  const StaggeredIndex<Dim>& rows_;
  bool is_found_ = false;
  Index<Dim> cell_{};
  std::array<std::int32_t, cell_sites<Dim, K>> row_{};
};

}  // namespace minamo
