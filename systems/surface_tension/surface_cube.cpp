#include "systems/surface_tension/surface_cube.hpp"

#include "systems/bodies/geometry/clip.hpp"
#include "systems/shapes/simplices.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <span>

namespace minamo {

template <int Dim>
Vec<Dim> area_vector(const typename FreeSurface<Dim>::Element& element) {
  if constexpr (Dim == 2) {
    return {element[1].x[1] - element[0].x[1], element[0].x[0] - element[1].x[0]};
  } else {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t k = 2; k < element.size(); ++k)
      sum += 0.5 * (element[k - 1].x - element[0].x).cross(element[k].x - element[0].x);
    return sum;
  }
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

/// Of a segment or a triangle. [m^(d-1)]
template <int Dim>
double area_between(const std::array<Vec<Dim>, static_cast<std::size_t>(Dim)>& x) {
  if constexpr (Dim == 2) {
    return (x[1] - x[0]).norm();
  } else {
    return 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  }
}

/// Calls use(corners) for the divisions of a cube that its surface is found in, (E112); of a square one of two.
template <int Dim, class Use>
void for_each_simplex(const Use& use) {
  if constexpr (Dim == 2) {
    for (const auto& triangle : simplices_of_box<2>()) use(triangle);
  } else {
    for (const auto& of_box : symmetric_simplices_of_box<3>()) use(of_box.corner);
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
      // A cell with little room near a body has no particle, and sites around it no rows.
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
  meets_wall_ = (node_[0].on | node_[corners - 1].on) != 0;
  if (!is_cut_ && !meets_wall_ && bodies == nullptr) return;
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
  if (meets_wall_) add_wetted(piece);
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
    for_each_simplex<Dim>([&](const Simplex& simplex) { add_of(simplex, piece); });
  }
}

template <int Dim>
void SurfaceCube<Dim>::add_of(const Simplex& simplex, Piece& piece) const {
  if (has_body_) add_wetted_of_body(simplex, piece);
  if (is_cut_) cut(simplex, piece);
}

template <int Dim>
void SurfaceCube<Dim>::add_along(const Simplices& triangles, Piece& piece) const requires(Dim == 2) {
  for (const auto& triangle : triangles) add_of(triangle, piece);
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
  for (const auto& [a, b] : sides) {
    const bool a_is_in = node_[a].psi > 0;
    if (a_is_in == (node_[b].psi > 0) || ends.count == 2) continue;
    ends.push_back(a_is_in ? between(a, b) : between(b, a));
  }
  if (ends.count < 2) return;
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
    for_each_simplex<Dim>([&](const Simplex& simplex) { add_wetted(simplex, side, piece); });
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
  const double share = has_body_ ? positive_share_of_both(psi, solid) : positive_share(psi);
  const double area = area_between<Dim>(x) * share / Surface::covers;
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
    const double area = area_between<Dim>(x) * positive_share(psi) / Surface::covers;
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
  Corners on_edges;
  // Of two triangles side by side the second has a corner more.
  for_each_cut(corner, inside, [&](const auto& edges) {
    for (std::size_t k = on_edges.count == 0 ? 0 : Dim - 1; k < edges.size(); ++k)
      on_edges.push_back(between(edges[k][0], edges[k][1]));
  });
  const Slopes directions = slopes(corner, inside);
  if (has_body_) {
    add_outside_of_bodies(piece, directions, on_edges);
  } else {
    add(piece, directions, on_edges);
  }
}

template <int Dim>
void SurfaceCube<Dim>::add_outside_of_bodies(Piece& piece, const Slopes& slopes, const Corners& outline) const {
  const auto on_wall = [&](const Corner& open, const Corner& closed) {
    const double part = open.solid / (open.solid - closed.solid);
    Corner between = open;
    between.place.x += part * (closed.place.x - open.place.x);
    between.on &= closed.on;
    between.solid = 0;
    between.place.on_body = static_cast<std::int32_t>(piece.on_bodies.size());
    piece.on_bodies.push_back({closed.place.in, closed.place.out, closed.place.share, part, slopes.off_body, body_});
    return between;
  };
  Corners open;
  const std::size_t edges = Dim == 2 ? 1 : outline.count;
  for (std::size_t k = 0; k < edges; ++k) {
    const Corner& from = outline.at[k];
    const Corner& to = outline.at[(k + 1) % outline.count];
    if (from.solid > 0) open.push_back(from);
    if ((from.solid > 0) != (to.solid > 0)) open.push_back(from.solid > 0 ? on_wall(from, to) : on_wall(to, from));
    if (Dim == 2 && to.solid > 0) open.push_back(to);
  }
  add(piece, slopes, open);
}

template <int Dim>
void SurfaceCube<Dim>::add(Piece& piece, const Slopes& slopes, const Corners& outline) const {
  if (outline.count < Dim) return;
  typename Surface::Element element;
  for (std::size_t k = 0; k < outline.count; ++k) element.push_back(outline.at[k].place);
  // The direction of less than that would be rounding.
  constexpr double least = 1e-12;
  const Vec<Dim> area = area_vector<Dim>(element);
  if (area.norm() <= least * std::pow((node_[corners - 1].x - node_[0].x).norm(), Dim - 1)) return;
  if (area.dot(slopes.out) < 0) element.turn_around();
  piece.areas.free += area.norm() / Surface::covers;
  piece.elements.push_back(element);
  for (std::size_t side = 0; side < 2 * Dim; ++side) {
    add_contacts(piece, outline, Vec<Dim>::Unit(static_cast<Eigen::Index>(side / 2)), slopes.out, staggered::none,
                 [&](const Corner& c) { return (c.on & 1U << side) != 0; });
  }
  if (!has_body_) return;
  add_contacts(piece, outline, slopes.off_body, slopes.out, body_,
               [&](const Corner& c) { return c.place.on_body != staggered::none; });
}

/// Ends of a segment, or sides of a polygon, that are on a wall. What lies in the wall has none.
template <int Dim>
template <class IsOn>
void SurfaceCube<Dim>::add_contacts(Piece& piece, const Corners& outline, const Vec<Dim>& normal, const Vec<Dim>& out,
                                    std::int32_t body, const IsOn& is_on) const {
  const std::span at(outline.at.data(), outline.count);
  if (std::all_of(at.begin(), at.end(), is_on)) return;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Corner& next = at[(k + 1) % at.size()];
    if (!is_on(at[k]) || (Dim == 3 && !is_on(next))) continue;
    typename Surface::Contact contact;
    contact.corner[0] = at[k].place;
    Vec<Dim> outward = out - out.dot(normal) * normal;
    if constexpr (Dim == 3) {
      contact.corner[1] = next.place;
      const Vec<3> line = next.place.x - at[k].place.x;
      if (line.squaredNorm() == 0) continue;
      outward -= outward.dot(line) / line.squaredNorm() * line;
    }
    if (outward.squaredNorm() == 0) continue;
    contact.outward = outward.normalized();
    contact.body = body;
    piece.contacts.push_back(contact);
  }
}

template Vec<2> area_vector<2>(const FreeSurface<2>::Element&);
template Vec<3> area_vector<3>(const FreeSurface<3>::Element&);
template double positive_share_of_both<2>(const std::array<double, 2>&, const std::array<double, 2>&);
template double positive_share_of_both<3>(const std::array<double, 3>&, const std::array<double, 3>&);
template class SurfaceCube<2>;
template class SurfaceCube<3>;

}  // namespace minamo
