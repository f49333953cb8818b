#pragma once
/// \file
/// What moving a particle for the sake of volume may do.

#include "systems/transfer/advect.hpp"

namespace minamo {

/// x moved by a shift of at most 0.1 h, since a shift is a correction and not a motion; inside the box.
template <int Dim>
inline Vec<Dim> shifted(const Grid<Dim>& grid, const Vec<Dim>& x, Vec<Dim> shift) {
  const double longest = 0.1 * grid.spacing;
  const double square = shift.squaredNorm();
  if (square > longest * longest) shift *= longest / std::sqrt(square);
  return inside_box<Dim>(grid, Vec<Dim>(x + shift)).x;
}

}  // namespace minamo
