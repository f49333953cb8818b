#pragma once
/// \file
/// Triangles and tetrahedra that a square or a cube falls into, and the surface that cuts one.

#include <algorithm>
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

/// The two triangles of a square on both sides of the diagonal through its corners 1 and 2; simplices_of_box() are on
/// both sides of the other one.
constexpr std::array<std::array<std::size_t, 3>, 2> other_triangles_of_square() { return {{{0, 1, 2}, {1, 2, 3}}}; }

/// A simplex of a division of a box, and its share of it.
template <int Dim>
struct SimplexOfBox {
  std::array<std::size_t, static_cast<std::size_t>(Dim) + 1> corner;
  double share;
};

/// How many divisions symmetric_simplices_of_box() are of.
inline constexpr int divisions_of_box = 2;

/// Two divisions of a square or a cube, each along the diagonals of its faces that the other leaves: together they
/// prefer no diagonal. Next to each other, those of the one kind fit those of the other.
template <int Dim>
constexpr auto symmetric_simplices_of_box() {
  if constexpr (Dim == 2) {
    constexpr double half = 1.0 / 2;
    return std::array<SimplexOfBox<2>, 4>{{{{0, 1, 3}, half}, {{0, 2, 3}, half}, {{0, 1, 2}, half}, {{1, 2, 3}, half}}};
  } else {
    constexpr double middle = 1.0 / 3;
    constexpr double at_corner = 1.0 / 6;
    return std::array<SimplexOfBox<3>, 10>{{{{0, 3, 5, 6}, middle},
                                            {{0, 1, 3, 5}, at_corner},
                                            {{0, 2, 3, 6}, at_corner},
                                            {{0, 4, 5, 6}, at_corner},
                                            {{3, 5, 6, 7}, at_corner},
                                            {{1, 2, 4, 7}, middle},
                                            {{0, 1, 2, 4}, at_corner},
                                            {{1, 2, 3, 7}, at_corner},
                                            {{1, 4, 5, 7}, at_corner},
                                            {{2, 4, 6, 7}, at_corner}}};
  }
}

/// Puts the corners of a simplex that are inside first, otherwise in the order that they have. \return how many are
template <std::size_t Corners, class IsInside>
std::size_t put_inside_first(std::array<std::size_t, Corners>& corner, const IsInside& is_inside) {
  const auto outside = std::stable_partition(corner.begin(), corner.end(), is_inside);
  return static_cast<std::size_t>(outside - corner.begin());
}

/// Calls use(edges) for what parts the corners inside from those outside, between points on edges, each given by its
/// corner inside and the one outside: a segment in a triangle; in a tetrahedron a triangle around a corner that is
/// alone on its side, two between two corners and two. Nothing where all are on one side. \param corner  those inside
/// first
template <std::size_t Corners, class Use>
void for_each_cut(const std::array<std::size_t, Corners>& corner, std::size_t inside, const Use& use) {
  using Edges = std::array<std::array<std::size_t, 2>, Corners - 1>;
  if constexpr (Corners == 3) {
    const auto& [a, b, c] = corner;
    if (inside == 1) use(Edges{{{a, b}, {a, c}}});
    if (inside == 2) use(Edges{{{a, c}, {b, c}}});
  } else {
    const auto& [a, b, c, d] = corner;
    if (inside == 1) use(Edges{{{a, b}, {a, c}, {a, d}}});
    if (inside == 2) {
      use(Edges{{{a, c}, {a, d}, {b, d}}});
      use(Edges{{{a, c}, {b, d}, {b, c}}});
    }
    if (inside == 3) use(Edges{{{a, d}, {b, d}, {c, d}}});
  }
}

}  // namespace minamo
