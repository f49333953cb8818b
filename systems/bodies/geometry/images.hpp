#pragma once
/// \file
/// Images of a point beyond the ends of periodic axes.

#include "components/grid.hpp"

namespace minamo {

/// use(y) for a point and its images beyond the ends of periodic axes that a body may have near.
template <int Dim, class Use>
void for_each_image(const Grid<Dim>& grid, const Vec<Dim>& x, const Use& use) {
  std::array<Vec<Dim>, power(3, Dim)> images;
  images[0] = x;
  std::size_t count = 1;
  for (int d = 0; d < Dim; ++d) {
    if (!grid.periodic[static_cast<std::size_t>(d)]) continue;
    const Vec<Dim> length = (grid.high[d] - grid.low[d]) * Vec<Dim>::Unit(d);
    for (std::size_t k = 0, before = count; k < before; ++k) {
      images[count++] = images[k] - length;
      images[count++] = images[k] + length;
    }
  }
  for (std::size_t k = 0; k < count; ++k) use(images[k]);
}

}  // namespace minamo
