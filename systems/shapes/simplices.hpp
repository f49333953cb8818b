#pragma once
/// \file
/// Triangles and tetrahedra that a square or a cube falls into.

#include <array>
#include <cstddef>

namespace minamo {

/// Corners by their bits, x lowest, from all low to all high along the edges: two triangles or six tetrahedra that fit
/// those of the next square or cube.
template <int Dim>
constexpr auto simplices_of_box() {
  if constexpr (Dim == 2) {
    return std::array<std::array<std::size_t, 3>, 2>{{{0, 1, 3}, {0, 2, 3}}};
  } else {
    return std::array<std::array<std::size_t, 4>, 6>{
        {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};
  }
}

}  // namespace minamo
