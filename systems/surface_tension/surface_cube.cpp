#include "systems/surface_tension/surface_cube.hpp"

#include "systems/bodies/clip.hpp"
#include "systems/shapes/simplices.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace minamo {

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

template <std::size_t N>
double positive_share_of_both(const std::array<double, N>& first, const std::array<double, N>& second) {
  std::array<std::size_t, N> corner;
  for (std::size_t k = 0; k < N; ++k) corner[k] = k;
  const std::size_t inside = put_inside_first(corner, [&](std::size_t c) { return second[c] > 0; });
  if (inside == 0) return 0;
  if (inside == N) return positive_share<N>(first);
  // What one corner is cut off with.
  const auto at_corner = [&](std::size_t alone) {
    std::array<double, N> value{first[alone]};
    double share = 1;
    std::size_t k = 1;
    for (const std::size_t c : corner) {
      if (c == alone) continue;
      const double part = second[alone] / (second[alone] - second[c]);
      value[k++] = first[alone] + part * (first[c] - first[alone]);
      share *= part;
    }
    return share * positive_share<N>(value);
  };
  return inside == 1 ? at_corner(corner[0]) : positive_share<N>(first) - at_corner(corner[N - 1]);
}

namespace {

/// Not of length 1.
template <int Dim>
Vec<Dim> normal_of(const typename FreeSurface<Dim>::Element& element) {
  if constexpr (Dim == 2) {
    return {element[1].x[1] - element[0].x[1], element[0].x[0] - element[1].x[0]};
  } else {
    return (element[1].x - element[0].x).cross(element[2].x - element[0].x);
  }
}

}  // namespace

template <int Dim>
SurfaceCube<Dim>::SurfaceCube(const SurfaceLattice<Dim>& lattice, std::span<const double> psi, double outside,
                              const Index<Dim>& base, const SurfaceBodies<Dim>* bodies, double cosine_of_sides)
    : cosine_of_sides_(cosine_of_sides) {
  for (std::size_t c = 0; c < corners; ++c) {
    Node& node = node_[c];
    node.at = base;
    for (std::size_t d = 0; d < Dim; ++d) {
      node.at[d] += static_cast<int>(c >> d & 1U);
      if (lattice.axis(d).is_low_wall(node.at[d])) node.on |= 1U << (2 * d);
      if (lattice.axis(d).is_high_wall(node.at[d])) node.on |= 1U << (2 * d + 1);
    }
    if (bodies != nullptr) {
      // A cell with little room beside a body has no particle, and sites around it no rows.
      lattice.for_each_source_site(node.at, [&](const Index<Dim>& site, double weight) {
        const auto row = lattice.row_of_site(site);
        node.psi += weight * (row ? psi[*row] : bodies->around.at(site));
      });
      continue;
    }
    lattice.for_each_source(node.at,
                            [&](const auto& row, double weight) { node.psi += weight * (row ? psi[*row] : outside); });
  }
  is_cut_ = false;
  for (const Node& node : node_) is_cut_ = is_cut_ || (node.psi > 0) != (node_[0].psi > 0);
  is_beside_wall_ = (node_[0].on | node_[corners - 1].on) != 0;
  if (!is_cut_ && !is_beside_wall_ && bodies == nullptr) return;
  for (Node& node : node_) node.x = lattice.place(node.at);
  if (bodies != nullptr) find_bodies(*bodies);
}

template <int Dim>
void SurfaceCube<Dim>::find_bodies(const SurfaceBodies<Dim>& bodies) {
  for (Node& node : node_) {
    node.solid = bodies.nearest(node.x).distance;
    has_body_ = has_body_ || node.solid <= 0;
  }
  if (!has_body_) return;
  body_ = bodies.nearest(0.5 * (node_[0].x + node_[corners - 1].x)).body;
  cosine_of_body_ = bodies.walls[static_cast<std::size_t>(body_)].cosine_of_contact_angle;
}

template <int Dim>
void SurfaceCube<Dim>::add_to(Piece& piece) const {
  if (is_beside_wall_) add_wetted(piece);
  if (!is_cut_ && !has_body_) return;
  if constexpr (Dim == 2) {
    // Along the higher diagonal, as in the mirror. What lies along the one or the other changes from one to the other
    // where both are as high, and the surface is straight.
    switch (bend()) {
    case Bend::along_first:
      return add_along(simplices_of_box<2>(), piece);
    case Bend::along_second:
      return add_along(other_triangles_of_square(), piece);
    case Bend::none:
      return add_undivided(piece);
    }
  } else {
    add_along(simplices_of_box<Dim>(), piece);
  }
}

template <int Dim>
void SurfaceCube<Dim>::add_along(const Simplices& simplices, Piece& piece) const {
  for (const auto& simplex : simplices) {
    if (has_body_) add_wetted_of_body(simplex, piece);
    if (is_cut_) cut(simplex, piece);
  }
}

/// Of a square; of the distance from a body, if that is not straight.
template <int Dim>
typename SurfaceCube<Dim>::Bend SurfaceCube<Dim>::bend() const requires(Dim == 2) {
  constexpr double rounding = 1e-9;
  const auto of = [&](double Node::*value) {
    const double first = node_[0].*value + node_[3].*value;
    const double second = node_[1].*value + node_[2].*value;
    double size = 0;
    for (const Node& node : node_) size = std::max(size, std::abs(node.*value));
    if (std::abs(first - second) <= rounding * size) return Bend::none;
    return first > second ? Bend::along_first : Bend::along_second;
  };
  const Bend of_body = has_body_ ? of(&Node::solid) : Bend::none;
  return of_body == Bend::none ? of(&Node::psi) : of_body;
}

/// Of a square in which all is linear: between points on its sides.
template <int Dim>
void SurfaceCube<Dim>::add_undivided(Piece& piece) const requires(Dim == 2) {
  if (has_body_) {
    for (const auto& simplex : simplices_of_box<Dim>()) add_wetted_of_body(simplex, piece);
  }
  if (!is_cut_) return;
  constexpr std::array<std::array<std::size_t, 2>, 4> sides{{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
  Corners ends;
  std::size_t count = 0;
  for (const auto& [a, b] : sides) {
    const bool a_is_in = node_[a].psi > 0;
    if (a_is_in == (node_[b].psi > 0) || count == ends.size()) continue;
    ends[count++] = a_is_in ? between(a, b) : between(b, a);
  }
  if (count < ends.size()) return;
  // Of a plane, by the triangle of the corners 0, 1 and 2.
  Slopes directions{-gradient({0, 1, 2}, &Node::psi)};
  if (!has_body_) return add(piece, directions, ends);
  directions.off_body = gradient({0, 1, 2}, &Node::solid).stableNormalized();
  add_outside_of_bodies(piece, directions, ends);
}

/// What of the sides of the box is wet in this cube.
template <int Dim>
void SurfaceCube<Dim>::add_wetted(Piece& piece) const {
  for (const SidesOfBox side : {1U, 2U, 4U, 8U, 16U, 32U}) {
    for (const auto& simplex : simplices_of_box<Dim>()) add_wetted(simplex, side, piece);
  }
}

/// Of the face of a simplex on a side, if it has one.
template <int Dim>
void SurfaceCube<Dim>::add_wetted(const Simplex& simplex, SidesOfBox side, Piece& piece) const {
  std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> x;
  std::array<double, static_cast<std::size_t>(Dim)> psi{};
  std::array<double, static_cast<std::size_t>(Dim)> solid{};
  std::size_t count = 0;
  for (const std::size_t c : simplex) {
    if ((node_[c].on & side) == 0) continue;
    x[count] = node_[c].x;
    psi[count] = node_[c].psi;
    solid[count++] = node_[c].solid;
  }
  if (count != Dim) return;
  const double area = area_of<Dim>(x) * (has_body_ ? positive_share_of_both(psi, solid) : positive_share(psi));
  piece.areas.wetted += area;
  piece.areas.gained += cosine_of_sides_ * area;
}

template <int Dim>
void SurfaceCube<Dim>::add_wetted_of_body(Simplex corner, Piece& piece) const {
  const std::size_t open = put_inside_first(corner, [&](std::size_t c) { return node_[c].solid > 0; });
  for_each_cut(corner, open, [&](const auto& edges) {
    std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> x;
    std::array<double, static_cast<std::size_t>(Dim)> psi{};
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Node& a = node_[edges[k][0]];
      const Node& b = node_[edges[k][1]];
      const double part = a.solid / (a.solid - b.solid);
      x[k] = a.x + part * (b.x - a.x);
      psi[k] = a.psi + part * (b.psi - a.psi);
    }
    const double area = area_of<Dim>(x) * positive_share(psi);
    piece.areas.wetted_of_bodies += area;
    piece.areas.gained += cosine_of_body_ * area;
  });
}

template <int Dim>
typename SurfaceCube<Dim>::Corner SurfaceCube<Dim>::between(std::size_t in, std::size_t out) const {
  const Node& a = node_[in];
  const Node& b = node_[out];
  const double share = a.psi / (a.psi - b.psi);
  return {{a.x + share * (b.x - a.x), a.at, b.at, share}, a.on & b.on, a.solid + share * (b.solid - a.solid)};
}

/// Of what is linear in a simplex.
template <int Dim>
Vec<Dim> SurfaceCube<Dim>::gradient(const Simplex& corner, double Node::*value) const {
  Mat<Dim> edges;
  Vec<Dim> rise;
  const Node& from = node_[corner[0]];
  for (std::size_t k = 1; k < corner.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k) - 1;
    edges.row(row) = (node_[corner[k]].x - from.x).transpose();
    rise[row] = node_[corner[k]].*value - from.*value;
  }
  return edges.inverse() * rise;
}

template <int Dim>
typename SurfaceCube<Dim>::Slopes SurfaceCube<Dim>::slopes(const Simplex& corner, std::size_t inside) const {
  Slopes slopes{Vec<Dim>::Zero()};
  if (has_body_) {
    slopes.out = -gradient(corner, &Node::psi);
    slopes.off_body = gradient(corner, &Node::solid).stableNormalized();
    return slopes;
  }
  for (std::size_t k = 0; k < inside; ++k) slopes.out -= node_[corner[k]].x / static_cast<double>(inside);
  for (std::size_t k = inside; k < corner.size(); ++k)
    slopes.out += node_[corner[k]].x / static_cast<double>(corner.size() - inside);
  return slopes;
}

template <int Dim>
void SurfaceCube<Dim>::cut(Simplex corner, Piece& piece) const {
  const std::size_t inside = put_inside_first(corner, [&](std::size_t c) { return node_[c].psi > 0; });
  if (inside == 0 || inside == corner.size()) return;
  const Slopes directions = slopes(corner, inside);
  for_each_cut(corner, inside, [&](const auto& edges) {
    Corners on_edge;
    for (std::size_t k = 0; k < edges.size(); ++k) on_edge[k] = between(edges[k][0], edges[k][1]);
    if (has_body_) {
      add_outside_of_bodies(piece, directions, on_edge);
    } else {
      add(piece, directions, on_edge);
    }
  });
}

template <int Dim>
void SurfaceCube<Dim>::add_outside_of_bodies(Piece& piece, const Slopes& slopes, const Corners& corner) const {
  std::array<std::size_t, static_cast<std::size_t>(Dim)> order;
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const std::size_t open = put_inside_first(order, [&](std::size_t k) { return corner[k].solid > 0; });
  if (open == 0) return;
  if (open == order.size()) return add(piece, slopes, corner);
  const auto on_wall = [&](std::size_t from, std::size_t to) {
    const Corner& a = corner[order[from]];
    const Corner& b = corner[order[to]];
    const double part = a.solid / (a.solid - b.solid);
    Corner between = a;
    between.place.x += part * (b.place.x - a.place.x);
    between.on &= b.on;
    between.solid = 0;
    between.place.on_body = static_cast<std::int32_t>(piece.on_bodies.size());
    piece.on_bodies.push_back({b.place.in, b.place.out, b.place.share, part, slopes.off_body, body_});
    return between;
  };
  if constexpr (Dim == 2) {
    add(piece, slopes, {corner[order[0]], on_wall(0, 1)});
  } else if (open == 1) {
    add(piece, slopes, {corner[order[0]], on_wall(0, 1), on_wall(0, 2)});
  } else {
    const Corner far = on_wall(1, 2);
    add(piece, slopes, {corner[order[0]], corner[order[1]], far});
    add(piece, slopes, {corner[order[0]], far, on_wall(0, 2)});
  }
}

template <int Dim>
void SurfaceCube<Dim>::add(Piece& piece, const Slopes& slopes, Corners corner) const {
  typename Surface::Element element;
  for (std::size_t k = 0; k < corner.size(); ++k) element[k] = corner[k].place;
  // The direction of less than that would be rounding.
  constexpr double least = 1e-12;
  const double area = area_of<Dim>(element);
  if (area <= least * std::pow((node_[corners - 1].x - node_[0].x).norm(), Dim - 1)) return;
  if (normal_of<Dim>(element).dot(slopes.out) < 0) std::swap(element[0], element[1]);
  piece.areas.free += area;
  piece.elements.push_back(element);
  for (std::size_t side = 0; side < 2 * Dim; ++side) {
    add_contact(piece, corner, Vec<Dim>::Unit(static_cast<Eigen::Index>(side / 2)), slopes.out, staggered::none,
                [&](const Corner& c) { return (c.on & 1U << side) != 0; });
  }
  if (!has_body_) return;
  add_contact(piece, corner, slopes.off_body, slopes.out, body_,
              [&](const Corner& c) { return c.place.on_body != staggered::none; });
}

/// Where all but one of the corners are on a wall.
template <int Dim>
template <class IsOn>
void SurfaceCube<Dim>::add_contact(Piece& piece, const Corners& corner, const Vec<Dim>& normal, Vec<Dim> out,
                                   std::int32_t body, const IsOn& is_on) const {
  typename Surface::Contact contact;
  std::size_t count = 0;
  for (const Corner& c : corner) {
    if (is_on(c) && count < contact.corner.size()) contact.corner[count++] = c.place;
  }
  if (count < contact.corner.size()) return;
  out -= out.dot(normal) * normal;
  if constexpr (Dim == 3) {
    const Vec<3> line = contact.corner[1].x - contact.corner[0].x;
    if (line.squaredNorm() == 0) return;
    out -= out.dot(line) / line.squaredNorm() * line;
  }
  if (out.squaredNorm() == 0) return;
  contact.outward = out.normalized();
  contact.body = body;
  piece.contacts.push_back(contact);
}

template double area_of<2>(const std::array<Vec<2>, 2>&);
template double area_of<3>(const std::array<Vec<3>, 3>&);
template double area_of<2>(const FreeSurface<2>::Element&);
template double area_of<3>(const FreeSurface<3>::Element&);
template double positive_share_of_both<2>(const std::array<double, 2>&, const std::array<double, 2>&);
template double positive_share_of_both<3>(const std::array<double, 3>&, const std::array<double, 3>&);
template class SurfaceCube<2>;
template class SurfaceCube<3>;

}  // namespace minamo
