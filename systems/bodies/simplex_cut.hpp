#pragma once
/// \file
/// What a distance leaves open of a box, and its surface in it, piece by piece: small boxes, and in those that are cut
/// triangles or tetrahedra in which the distance is taken for linear.

#include "systems/bodies/clip.hpp"
#include "systems/shapes/simplices.hpp"

#include <Eigen/Geometry>

#include <vector>

namespace minamo {

/// A piece of the surface.
template <int Dim>
struct SurfacePiece {
  Vec<Dim> middle;
  double area;  ///< length in the plane [m^(d-1)]
};

/// A small box.
template <int Dim>
struct CutPiece {
  Vec<Dim> middle;  ///< of what is open
  double volume;    ///< of what is open [m^d]
  std::vector<SurfacePiece<Dim>> surface;
};

/// The surface in a simplex: between points on its edges.
template <int Dim>
void add_surface(const std::array<Vec<Dim>, static_cast<std::size_t>(Dim) + 1>& corner,
                 const std::array<double, static_cast<std::size_t>(Dim) + 1>& value,
                 std::vector<SurfacePiece<Dim>>& surface) {
  std::vector<Vec<Dim>> open_corners;
  std::vector<double> open_values;
  std::vector<Vec<Dim>> shut_corners;
  std::vector<double> shut_values;
  for (std::size_t k = 0; k < corner.size(); ++k) {
    (value[k] > 0 ? open_corners : shut_corners).push_back(corner[k]);
    (value[k] > 0 ? open_values : shut_values).push_back(value[k]);
  }
  if (open_corners.empty() || shut_corners.empty()) return;
  const auto crossing = [&](std::size_t above, std::size_t below) -> Vec<Dim> {
    const double part = open_values[above] / (open_values[above] - shut_values[below]);
    return open_corners[above] + part * (shut_corners[below] - open_corners[above]);
  };
  if constexpr (Dim == 2) {
    const bool one_is_open = open_corners.size() == 1;
    const Vec<2> a = crossing(0, 0);
    const Vec<2> b = one_is_open ? crossing(0, 1) : crossing(1, 0);
    surface.push_back({0.5 * (a + b), (b - a).norm()});
  } else {
    const auto add = [&](const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
      surface.push_back({(a + b + c) / 3, 0.5 * (b - a).cross(c - a).norm()});
    };
    if (open_corners.size() == 1) {
      add(crossing(0, 0), crossing(0, 1), crossing(0, 2));
    } else if (open_corners.size() == 3) {
      add(crossing(0, 0), crossing(1, 0), crossing(2, 0));
    } else {
      add(crossing(0, 0), crossing(0, 1), crossing(1, 1));
      add(crossing(0, 0), crossing(1, 1), crossing(1, 0));
    }
  }
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
  for (std::size_t k = 0; k < at.size(); ++k) at[k] = distance(node_at(k, nodes));
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
      constexpr auto simplices = simplices_of_box<Dim>();
      for (const auto& simplex : simplices) {
        std::array<Vec<Dim>, static_cast<std::size_t>(Dim) + 1> x;
        std::array<double, static_cast<std::size_t>(Dim) + 1> v;
        for (std::size_t c = 0; c < x.size(); ++c) {
          x[c] = corner[simplex[c]];
          v[c] = value[simplex[c]];
        }
        piece.volume += whole / static_cast<double>(simplices.size()) * positive_share(v);
        add_surface<Dim>(x, v, piece.surface);
      }
    }
    use(piece);
  }
}

}  // namespace minamo
