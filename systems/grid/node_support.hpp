#pragma once
/// \file
/// The 3^d nodes of a dual cell, the weights of a particle on them, and the loops that all kernels share:
/// for_each_support() over the nodes, for_each_cell() to gather, for_each_cell_coloured() to scatter. For points that
/// are in no occupied cell: point_locator.hpp.

#include "components/cells.hpp"
#include "engine/schedule/parallel.hpp"
#include "systems/grid/basis.hpp"

#include <algorithm>

namespace minamo {

/// Calls body(k, offset) for the 3^d nodes of a support; offset (0 ... 2 per direction) from its first node, x fastest.
/// Clang takes it for too long to inline, and then TPIC scatters 1.6 times as slowly in 3-D.
template <int Dim, class Body>
[[gnu::always_inline]] inline void for_each_support(const Body& body) {
  std::size_t k = 0;
  if constexpr (Dim == 3) {
    for (int c = 0; c < 3; ++c) {
      for (int b = 0; b < 3; ++b) {
        for (int a = 0; a < 3; ++a) body(k++, Index<3>{a, b, c});
      }
    }
  } else {
    for (int b = 0; b < 3; ++b) {
      for (int a = 0; a < 3; ++a) body(k++, Index<2>{a, b});
    }
  }
}

/// The weights in a dual cell, one axis at a time.
template <int Dim>
using CellBasis = std::array<const AxisBasis*, static_cast<std::size_t>(Dim)>;

/// Where the nodes of a dual cell are.
template <int Dim>
struct SupportBox {
  CellBasis<Dim> basis;  ///< weights along every axis
  Index<Dim> first;      ///< lowest node; -1 at the low end of a periodic axis
  Vec<Dim> centre;       ///< the cell's own node [m]
  Vec<Dim> corner;       ///< the lowest node [m]
  double per_spacing;    ///< 1/h [1/m]

  /// \param own  the node in the middle of the cell
  SupportBox(const Grid<Dim>& grid, const Index<Dim>& own) : centre(grid.position(own)), per_spacing(1 / grid.spacing) {
    for (std::size_t d = 0; d < Dim; ++d) {
      basis[d] = &axis_basis<Dim>(grid, d, own[d]);
      first[d] = own[d] + basis[d]->first;
    }
    corner = grid.position(first);
  }
  /// The site of the node at an offset from the first.
  Index<Dim> site(const Grid<Dim>& grid, Index<Dim> offset) const {
    for (std::size_t d = 0; d < Dim; ++d) offset[d] = grid.wrapped(static_cast<int>(d), offset[d] + first[d]);
    return offset;
  }
};

/// The nodes of an occupied dual cell.
template <int Dim>
struct Support : SupportBox<Dim> {
  std::array<std::size_t, support_size<Dim>> node;  ///< rows in the node tables

  /// The nodes of `cell`.
  Support(const Grid<Dim>& grid, const typename OccupiedCells<Dim>::Cell& cell) : SupportBox<Dim>(grid, cell.node) {
    std::copy(cell.rows.begin(), cell.rows.end(), node.begin());
  }
  /// The row of the cell's own node.
  std::size_t own() const {
    std::size_t k = 0;
    for (std::size_t d = Dim; d-- > 0;) k = 3 * k + static_cast<std::size_t>(-this->basis[d]->first);
    return node[k];
  }
};

/// S_Ip and its gradient at a point, for the nodes of a support.
template <int Dim>
struct Weights {
  std::array<std::array<double, 3>, static_cast<std::size_t>(Dim)> value;  ///< per axis, of its three nodes
  std::array<std::array<double, 3>, static_cast<std::size_t>(Dim)> slope;  ///< [1/m]

  /// At the point y in the cell of `support`. Inlined, so that slopes nobody reads are not computed.
  [[gnu::always_inline]] Weights(const SupportBox<Dim>& support, const Vec<Dim>& y) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const double xi = (y[axis] - support.centre[axis]) * support.per_spacing;
      for (std::size_t a = 0; a < 3; ++a) {
        value[d][a] = support.basis[d]->value(a, xi);
        slope[d][a] = support.basis[d]->derivative(a, xi) * support.per_spacing;
      }
    }
  }
  /// S_I of the node at an offset from the first.
  double operator()(const Index<Dim>& offset) const {
    double product = 1;
    for (std::size_t d = 0; d < Dim; ++d) product *= value[d][static_cast<std::size_t>(offset[d])];
    return product;
  }
  /// grad S_I of it. [1/m]
  Vec<Dim> gradient(const Index<Dim>& offset) const {
    Vec<Dim> gradient;
    for (std::size_t i = 0; i < Dim; ++i) {
      double product = slope[i][static_cast<std::size_t>(offset[i])];
      for (std::size_t d = 0; d < Dim; ++d) {
        if (d != i) product *= value[d][static_cast<std::size_t>(offset[d])];
      }
      gradient[static_cast<Eigen::Index>(i)] = product;
    }
    return gradient;
  }
};

/// The node in whose dual cell a point lies; a point outside the box counts to the nearest cell.
/// \pre along a periodic axis the point lies in the range of fold().
template <int Dim>
Index<Dim> dual_cell(const Grid<Dim>& grid, const Vec<Dim>& y) {
  Index<Dim> node;
  for (int d = 0; d < Dim; ++d) {
    const double r = (y[d] - grid.low[d]) / grid.spacing + 0.5;
    node[static_cast<std::size_t>(d)] = std::clamp(static_cast<int>(r), 0, grid.nodes(d) - 1);
  }
  return node;
}

/// fold() of a point that may lie outside the box.
template <int Dim>
Vec<Dim> fold_back(const Grid<Dim>& grid, Vec<Dim> y);

/// The image of a point whose dual cell has its own node at the right place: low - h/2 <= y < high - h/2 along periodic
/// axes; inside the box along the others.
template <int Dim>
inline Vec<Dim> fold(const Grid<Dim>& grid, const Vec<Dim>& y) {
  bool stays = true;
  for (int d = 0; d < Dim; ++d) {
    const double end = grid.high[d] - (grid.periodic[static_cast<std::size_t>(d)] ? grid.spacing : 0);
    stays = stays && y[d] >= grid.low[d] && y[d] <= end;
  }
  return stays ? y : fold_back<Dim>(grid, y);
}

/// Particles keep off walls by this share of h. On a wall they would give the nodes next to it weight zero and a slope;
/// and those that come to it again and again would be closer to each other than rounding.
constexpr double off_wall = 1e-6;

/// A point, moved off the walls that it is too near to or beyond.
template <int Dim>
inline Vec<Dim> keep_off_walls(const Grid<Dim>& grid, Vec<Dim> y) {
  const double margin = off_wall * grid.spacing;
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)]) continue;
    y[d] = std::clamp(y[d], grid.low[d] + margin, grid.high[d] - margin);
  }
  return y;
}

/// Calls body(place in cells.cells, cell), side by side. For kernels that write rows of their particles or cells only.
template <int Dim, class Body>
void for_each_cell(const OccupiedCells<Dim>& cells, const Body& body) {
  constexpr std::size_t cells_per_task = 64;
  for_each_row(
      cells.cells.size(), [&](std::size_t c) { body(c, cells.cells[c]); }, cells_per_task);
}

/// The same for kernels that write rows of nodes: one colour of blocks after the other, so that every node gets its
/// contributions in an order that does not depend on the number of threads.
template <int Dim, class Body>
void for_each_cell_coloured(const OccupiedCells<Dim>& cells, const Body& body) {
  constexpr std::size_t blocks_per_task = 4;
  for (const auto& blocks : cells.blocks) {
    for_each_row(
        blocks.size(),
        [&](std::size_t b) {
          for (std::size_t c = blocks[b].begin; c < blocks[b].end; ++c) body(c, cells.cells[c]);
        },
        blocks_per_task);
  }
}

}  // namespace minamo
