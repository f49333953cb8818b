#pragma once
/// \file
/// Support and weights of a point wherever it is, for loops over particles that have left the cells they are sorted by.

#include "systems/grid/support.hpp"

namespace minamo {

template <int Dim>
struct Place {
  Support<Dim> support;
  Weights<Dim> weights;

  Place(const Grid<Dim>& grid, const Vec<Dim>& x) : Place(grid, fold<Dim>(grid, x), Folded{}) {}

 private:
  struct Folded {};
  Place(const Grid<Dim>& grid, const Vec<Dim>& y, Folded)
      : support(grid, dual_cell<Dim>(grid, y)), weights(support, y) {}
};

}  // namespace minamo
