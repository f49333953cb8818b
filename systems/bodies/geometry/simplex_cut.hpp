#pragma once
/// \file
/// What a distance leaves open of a box, and its surface in it, piece by piece: small boxes, and in those that are cut
/// triangles or tetrahedra in which the distance is taken for linear, of two divisions that together prefer no
/// diagonal.

#include "systems/bodies/geometry/clip.hpp"
#include "systems/shapes/simplices.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numeric>
#include <vector>

namespace minamo {

/// A piece of the surface.
template <int Dim>
struct SurfacePiece {
  Vec<Dim> middle;
  double area;  ///< length in 2-D [m^(d-1)]
};

/// A small box.
template <int Dim>
struct CutPiece {
  Vec<Dim> middle;  ///< of what is open
  double volume;    ///< of what is open [m^d]
  std::vector<SurfacePiece<Dim>> surface;
};

/// The surface in a simplex, between points on its edges: one piece, in a tetrahedron of up to two triangles.
/// \param share  that its area counts with
template <int Dim>
void add_surface(const std::array<Vec<Dim>, static_cast<std::size_t>(Dim) + 1>& corner,
                 const std::array<double, static_cast<std::size_t>(Dim) + 1>& value, double share,
                 std::vector<SurfacePiece<Dim>>& surface) {
  std::array<std::size_t, static_cast<std::size_t>(Dim) + 1> order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t open = put_inside_first(order, [&](std::size_t k) { return value[k] > 0; });
  SurfacePiece<Dim> piece{Vec<Dim>::Zero(), 0};
  for_each_cut(order, open, [&](const auto& edges) {
    std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> x;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const auto [above, below] = edges[k];
      const double part = value[above] / (value[above] - value[below]);
      x[k] = corner[above] + part * (corner[below] - corner[above]);
    }
    double area = 0;
    Vec<Dim> sum = x[0] + x[1];
    if constexpr (Dim == 2) {
      area = (x[1] - x[0]).norm();
    } else {
      area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
      sum += x[2];
    }
    piece.area += share * area;
    piece.middle += share * area / Dim * sum;
  });
  if (piece.area == 0) return;
  piece.middle /= piece.area;
  surface.push_back(piece);
}

/// A cube of small boxes.
template <int Dim>
struct SmallBoxes {
  Vec<Dim> low;  ///< corner of the first
  double width;  ///< of each [m]
};

/// Calls use(piece) for `count` small boxes per direction, but for those where nothing is open.
template <int Dim, class Distance, class Use>
void for_each_piece_of_box(const SmallBoxes<Dim>& boxes, int count, const Distance& distance, const Use& use) {
  constexpr std::size_t corners = power(2, Dim);
  const auto nodes = static_cast<std::size_t>(count) + 1;
  const auto node_at = [&](std::size_t row, std::size_t per_axis) {
    Vec<Dim> x = boxes.low;
    for (int d = 0; d < Dim; ++d) {
      x[d] += boxes.width * static_cast<double>(row % per_axis);
      row /= per_axis;
    }
    return x;
  };
  std::vector<double> at(power(nodes, Dim));
  for (std::size_t k = 0; k < at.size(); ++k) {
    at[k] = distance(node_at(k, nodes));
    // Of corners that all lie on a wall, rounding would make anything.
    constexpr double on_wall = 1e-9;
    if (std::abs(at[k]) < on_wall * boxes.width) at[k] = 0;
  }
  const double whole = std::pow(boxes.width, Dim);
  CutPiece<Dim> piece;
  for (std::size_t k = 0; k < power(nodes - 1, Dim); ++k) {
    std::array<Vec<Dim>, corners> corner;
    std::array<double, corners> value;
    const Vec<Dim> low = node_at(k, nodes - 1);
    for (std::size_t c = 0; c < corners; ++c) {
      std::size_t row = 0;
      std::size_t stride = 1;
      std::size_t rest = k;
      corner[c] = low;
      for (int d = 0; d < Dim; ++d) {
        const std::size_t up = c >> static_cast<std::size_t>(d) & 1U;
        row += stride * (rest % (nodes - 1) + up);
        rest /= nodes - 1;
        stride *= nodes;
        corner[c][d] += boxes.width * static_cast<double>(up);
      }
      value[c] = at[row];
    }
    piece.surface.clear();
    piece.middle = low + Vec<Dim>::Constant(0.5 * boxes.width);
    piece.volume = 0;
    const auto is_open = [](double v) { return v > 0; };
    if (std::none_of(value.begin(), value.end(), is_open)) continue;
    if (std::all_of(value.begin(), value.end(), is_open)) {
      piece.volume = whole;
    } else {
      constexpr double per_division = 1.0 / divisions_of_box;
      for (const auto& [simplex, share] : symmetric_simplices_of_box<Dim>()) {
        std::array<Vec<Dim>, static_cast<std::size_t>(Dim) + 1> x;
        std::array<double, static_cast<std::size_t>(Dim) + 1> v;
        for (std::size_t c = 0; c < x.size(); ++c) {
          x[c] = corner[simplex[c]];
          v[c] = value[simplex[c]];
        }
        piece.volume += per_division * share * whole * positive_share(v);
        add_surface<Dim>(x, v, per_division, piece.surface);
      }
    }
    use(piece);
  }
}

}  // namespace minamo
