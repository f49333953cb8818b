#include "systems/surface_tension/free_surface.hpp"

#include "systems/bodies/clip.hpp"
#include "systems/conforming/quadratic_spline.hpp"
#include "systems/shapes/simplices.hpp"
#include "systems/surface_tension/point_sites.hpp"
#include "systems/surface_tension/surface_lattice.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace minamo {

double distance_of_fill(double fraction) {
  const double beyond = std::abs(fraction - 0.5);
  constexpr double of_half = 1.0 / 3;  // F(1/2) - 1/2
  double distance = quadratic_spline_reach - std::cbrt(6 * std::max(0.0, 0.5 - beyond));
  // s^3 - 9/4 s + 3 (F - 1/2) = 0, by the sine of a third of an angle.
  if (beyond < of_half) distance = std::numbers::sqrt3 * std::sin(std::asin(4 * beyond / std::numbers::sqrt3) / 3);
  return fraction < 0.5 ? -distance : distance;
}

template <int Dim>
double area_of(const std::array<Vec<Dim>, static_cast<std::size_t>(Dim)>& x) {
  if constexpr (Dim == 2) {
    return (x[1] - x[0]).norm();
  } else {
    return 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  }
}

template <int Dim>
double area_of(const typename FreeSurface<Dim>::Element& element) {
  std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> x;
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = element[k].x;
  return area_of<Dim>(x);
}

namespace {

/// Side 2 d or 2 d + 1 of the box as a bit.
using Sides = unsigned;

/// What a cube of the lattice holds of the surface.
template <int Dim>
class Cube {
 public:
  using Surface = FreeSurface<Dim>;
  using Piece = typename Surface::Piece;
  static constexpr std::size_t corners = power(2, Dim);

  Cube(const SurfaceLattice<Dim>& lattice, std::span<const double> psi, double outside, const Index<Dim>& base) {
    for (std::size_t c = 0; c < corners; ++c) {
      Node& node = node_[c];
      node.at = base;
      for (std::size_t d = 0; d < Dim; ++d) {
        node.at[d] += static_cast<int>(c >> d & 1U);
        if (lattice.axis(d).is_low_wall(node.at[d])) node.on |= 1U << (2 * d);
        if (lattice.axis(d).is_high_wall(node.at[d])) node.on |= 1U << (2 * d + 1);
      }
      lattice.for_each_source(
          node.at, [&](const auto& row, double weight) { node.psi += weight * (row ? psi[*row] : outside); });
    }
    is_cut_ = false;
    for (const Node& node : node_) is_cut_ = is_cut_ || (node.psi > 0) != (node_[0].psi > 0);
    is_beside_wall_ = (node_[0].on | node_[corners - 1].on) != 0;
    if (!is_cut_ && !is_beside_wall_) return;
    for (Node& node : node_) node.x = lattice.place(node.at);
  }

  void add_to(Piece& piece) const {
    if (is_beside_wall_) add_wetted(piece);
    if (!is_cut_) return;
    for (const auto& simplex : simplices_of_box<Dim>()) cut(simplex, piece);
  }

 private:
  using Simplex = std::array<std::size_t, static_cast<std::size_t>(Dim) + 1>;
  struct Node {
    Vec<Dim> x;
    Index<Dim> at;
    double psi = 0;  ///< [m]
    Sides on = 0;    ///< sides that it lies on
  };
  struct Corner {
    typename Surface::Corner place;
    Sides on;
  };
  using Corners = std::array<Corner, static_cast<std::size_t>(Dim)>;

  /// What of the sides of the box is wet in this cube.
  void add_wetted(Piece& piece) const {
    for (const Sides side : {1U, 2U, 4U, 8U, 16U, 32U}) {
      for (const auto& simplex : simplices_of_box<Dim>()) add_wetted(simplex, side, piece);
    }
  }
  /// Of the face of a simplex on a side, if it has one.
  void add_wetted(const Simplex& simplex, Sides side, Piece& piece) const {
    std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> x;
    std::array<double, static_cast<std::size_t>(Dim)> psi{};
    std::size_t count = 0;
    for (const std::size_t c : simplex) {
      if ((node_[c].on & side) == 0) continue;
      x[count] = node_[c].x;
      psi[count++] = node_[c].psi;
    }
    if (count == Dim) piece.wetted += area_of<Dim>(x) * positive_share(psi);
  }

  Corner between(std::size_t in, std::size_t out) const {
    const Node& a = node_[in];
    const Node& b = node_[out];
    const double share = a.psi / (a.psi - b.psi);
    return {{a.x + share * (b.x - a.x), a.at, b.at, share}, a.on & b.on};
  }

  void cut(Simplex corner, Piece& piece) const {
    const std::size_t inside = put_inside_first(corner, [&](std::size_t c) { return node_[c].psi > 0; });
    if (inside == 0 || inside == corner.size()) return;
    Vec<Dim> out = Vec<Dim>::Zero();
    for (std::size_t k = 0; k < inside; ++k) out -= node_[corner[k]].x / static_cast<double>(inside);
    for (std::size_t k = inside; k < corner.size(); ++k)
      out += node_[corner[k]].x / static_cast<double>(corner.size() - inside);
    for_each_cut(corner, inside, [&](const auto& edges) {
      Corners on_edge;
      for (std::size_t k = 0; k < edges.size(); ++k) on_edge[k] = between(edges[k][0], edges[k][1]);
      add(piece, out, on_edge);
    });
  }

  void add(Piece& piece, const Vec<Dim>& out, Corners corner) const {
    typename Surface::Element element;
    for (std::size_t k = 0; k < corner.size(); ++k) element[k] = corner[k].place;
    // The direction of less than that would be rounding.
    constexpr double least = 1e-12;
    const double area = area_of<Dim>(element);
    if (area <= least * std::pow((node_[corners - 1].x - node_[0].x).norm(), Dim - 1)) return;
    if (normal(element).dot(out) < 0) std::swap(element[0], element[1]);
    piece.area += area;
    piece.elements.push_back(element);
    for (std::size_t side = 0; side < 2 * Dim; ++side) add_contact(piece, out, corner, side);
  }

  void add_contact(Piece& piece, Vec<Dim> out, const Corners& corner, std::size_t side) const {
    typename Surface::Contact contact;
    std::size_t count = 0;
    for (const Corner& c : corner) {
      if ((c.on & 1U << side) != 0 && count < contact.corner.size()) contact.corner[count++] = c.place;
    }
    if (count < contact.corner.size()) return;
    out[static_cast<Eigen::Index>(side / 2)] = 0;
    if constexpr (Dim == 3) {
      const Vec<3> line = contact.corner[1].x - contact.corner[0].x;
      if (line.squaredNorm() == 0) return;
      out -= out.dot(line) / line.squaredNorm() * line;
    }
    if (out.squaredNorm() == 0) return;
    contact.outward = out.normalized();
    piece.contacts.push_back(contact);
  }

  /// Not of length 1.
  static Vec<Dim> normal(const typename Surface::Element& element) {
    if constexpr (Dim == 2) {
      return {element[1].x[1] - element[0].x[1], element[0].x[0] - element[1].x[0]};
    } else {
      return (element[1].x - element[0].x).cross(element[2].x - element[0].x);
    }
  }

  std::array<Node, corners> node_;
  bool is_cut_;
  bool is_beside_wall_;
};

/// Whether a cube counts to a row: to the first of its nodes that has one.
template <int Dim>
bool belongs_to(const SurfaceLattice<Dim>& lattice, const Index<Dim>& base, std::size_t row) {
  for (std::size_t c = 0; c < power(2, Dim); ++c) {
    Index<Dim> node = base;
    for (std::size_t d = 0; d < Dim; ++d) node[d] += static_cast<int>(c >> d & 1U);
    if (!lattice.is_site(node)) continue;
    if (const auto found = lattice.row(node)) return *found == row;
  }
  return false;
}

}  // namespace

template <int Dim>
void FindSurfaceDistance<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                          Read<StaggeredIndex<Dim>> rows, Read<GridCells<Dim>> cells,
                                          Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p,
                                          Read<particle::Volume> V_p, Read<staggered::Site<Dim>> site,
                                          Write<surface::Distance> psi) const {
  for_each_row(psi.size(), [&](std::size_t i) { psi[i] = 0; });
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      std::array<double, cell_sites<Dim, K>> volume{};
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const SplineWeights<Dim, K> weights(frame, frame.local(y_p[p]));
        for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
          volume[k] += V_p[p] * quadratic_weight<Dim, K>(weights, offset);
        });
      }
      const std::uint32_t* of_cell = sites->of(c);
      for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>&) { psi[of_cell[k]] += volume[k]; });
    });
  });
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  for_each_row(psi.size(), [&](std::size_t i) {
    const double phi = lattice.has(site[i]) ? std::min(1.0, psi[i] / lattice.capacity(site[i])) : 0;
    psi[i] = grid->spacing * distance_of_fill(phi);
  });
}

template <int Dim>
void FindFreeSurface<Dim>::operator()(Read<Grid<Dim>> grid, Read<StaggeredIndex<Dim>> rows,
                                      Read<staggered::Site<Dim>> site, Read<surface::Distance> psi,
                                      Write<FreeSurface<Dim>> surface) const {
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  const double outside = -quadratic_spline_reach * grid->spacing;
  constexpr std::size_t rows_per_piece = 256;
  const auto add_cubes_of = [&](std::size_t i, typename FreeSurface<Dim>::Piece& piece) {
    for (std::size_t c = 0; c < power(2, Dim); ++c) {
      Index<Dim> base;
      for (std::size_t d = 0; d < Dim; ++d)
        base[d] = lattice.axis(d).node_of(site[i][d]) - static_cast<int>(c >> d & 1U);
      if (belongs_to<Dim>(lattice, base, i)) Cube<Dim>(lattice, psi.span(), outside, base).add_to(piece);
    }
  };
  surface->pieces.resize(site.size() / rows_per_piece + 1);
  for_each_row(
      surface->pieces.size(),
      [&](std::size_t k) {
        auto& piece = surface->pieces[k];
        piece.elements.clear();
        piece.contacts.clear();
        piece.area = piece.wetted = 0;
        const std::size_t end = std::min(site.size(), (k + 1) * rows_per_piece);
        for (std::size_t i = k * rows_per_piece; i < end; ++i) {
          if (lattice.has(site[i])) add_cubes_of(i, piece);
        }
      },
      1);
  surface->area = surface->wetted = 0;
  for (const auto& piece : surface->pieces) {
    surface->area += piece.area;
    surface->wetted += piece.wetted;
  }
}

template double area_of<2>(const std::array<Vec<2>, 2>&);
template double area_of<3>(const std::array<Vec<3>, 3>&);
template double area_of<2>(const FreeSurface<2>::Element&);
template double area_of<3>(const FreeSurface<3>::Element&);
template struct FindSurfaceDistance<2>;
template struct FindSurfaceDistance<3>;
template struct FindFreeSurface<2>;
template struct FindFreeSurface<3>;

}  // namespace minamo
