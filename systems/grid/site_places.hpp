#pragma once
/// \file
/// Where faces and multipliers are, and numbers of places in a box of them.

#include "systems/grid/mac_grid.hpp"

namespace minamo {

/// Place of an index among `count` per direction, x fastest, and the index at a place.
template <int Dim>
std::size_t row_in(const Index<Dim>& count, const Index<Dim>& index) {
  std::size_t row = 0;
  for (std::size_t d = Dim; d-- > 0;)
    row = row * static_cast<std::size_t>(count[d]) + static_cast<std::size_t>(index[d]);
  return row;
}
/// How many places there are.
template <int Dim>
std::size_t rows_in(const Index<Dim>& count) {
  std::size_t rows = 1;
  for (const int along : count) rows *= static_cast<std::size_t>(along);
  return rows;
}
template <int Dim>
Index<Dim> index_in(const Index<Dim>& count, std::size_t row) {
  Index<Dim> index;
  for (std::size_t d = 0; d < Dim; ++d) {
    index[d] = static_cast<int>(row % static_cast<std::size_t>(count[d]));
    row /= static_cast<std::size_t>(count[d]);
  }
  return index;
}

template <int Dim>
Vec<Dim> middle_of_cell(const Grid<Dim>& grid, const Index<Dim>& cell) {
  return grid.position(cell) + Vec<Dim>::Constant(0.5 * grid.spacing);
}

/// Where faces and multipliers are: between the Greville points of neighbouring faces lies a multiplier.
template <int Dim>
class SitePlaces {
 public:
  SitePlaces(const Grid<Dim>& grid, const Splines<Dim>& splines) : grid_(grid), splines_(splines) {}
  explicit SitePlaces(const MacGrid<Dim>& mac) : SitePlaces(*mac.grid, *mac.splines) {}

  /// Greville point of the spline i of degree K along an axis. [m]
  double along(std::size_t d, int i) const;
  /// The box between the faces of a site: from its own to those of the sites above. [m]
  Bounds<Dim> box(const Index<Dim>& site) const;
  /// The middle of that, which may lie beyond the grid, where the last sites have faces but no multiplier. [m]
  Vec<Dim> middle(const Index<Dim>& site) const;
  /// Middle of a face of direction d. [m]
  Vec<Dim> face(const Index<Dim>& site, std::size_t d) const;
  /// Half of the diagonal of what the splines of a multiplier cover. [m]
  double reach() const;
  const Grid<Dim>& grid() const { return grid_; }
  const Splines<Dim>& splines() const { return splines_; }

 private:
  const Grid<Dim>& grid_;
  const Splines<Dim>& splines_;
};

}  // namespace minamo
