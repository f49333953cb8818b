#include "systems/shapes/closed_surface.hpp"

#include "components/vector_text.hpp"

#include <Eigen/Geometry>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace minamo::shapes {

namespace {

std::size_t next(std::size_t k) { return k < 2 ? k + 1 : 0; }

bool comes_before(const Vec<3>& a, const Vec<3>& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Corners at one place become the first of them.
void weld(const Triangles& mesh, double scale, const Vec<3>& move, ClosedSurface& surface) {
  std::vector<std::uint32_t> order(mesh.corner.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Vec<3>&at_a = mesh.corner[a], &at_b = mesh.corner[b];
    return at_a == at_b ? a < b : comes_before(at_a, at_b);
  });
  std::vector<std::uint32_t> first(mesh.corner.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_new = k == 0 || mesh.corner[order[k]] != mesh.corner[order[k - 1]];
    first[order[k]] = is_new ? order[k] : first[order[k - 1]];
  }
  std::vector<std::uint32_t> number(mesh.corner.size());
  for (std::uint32_t k = 0; k < first.size(); ++k) {
    number[k] = first[k] == k ? static_cast<std::uint32_t>(surface.corner.size()) : number[first[k]];
    if (first[k] == k) surface.corner.push_back(scale * mesh.corner[k] + move);
  }
  for (const auto& [a, b, c] : mesh.triangle) {
    const std::array<std::uint32_t, 3> corners{number[a], number[b], number[c]};
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      surface.triangle.push_back(corners);
  }
}

/// A side of a triangle.
struct Side {
  std::uint64_t corners;  ///< the lower one in the upper half
  std::uint32_t triangle;
  std::uint8_t number;
  bool is_upward;  ///< from the lower corner to the higher one

  std::uint32_t low() const { return static_cast<std::uint32_t>(corners >> 32); }
  std::uint32_t high() const { return static_cast<std::uint32_t>(corners); }
};

/// Ordered by their edges.
std::vector<Side> sides_of(const ClosedSurface& surface) {
  std::vector<Side> sides;
  sides.reserve(3 * surface.triangle.size());
  for (std::uint32_t t = 0; t < surface.triangle.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t from = surface.triangle[t][k];
      const std::uint64_t to = surface.triangle[t][next(k)];
      sides.push_back({std::min(from, to) << 32 | std::max(from, to), t, static_cast<std::uint8_t>(k), from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.triangle < b.triangle;
  });
  return sides;
}

/// Edges with something wrong: how many, and which triangle has the first.
struct WrongEdges {
  std::size_t count = 0;
  Side first{};

  void note(const Side& side) {
    if (count == 0 || side.triangle < first.triangle) first = side;
    ++count;
  }
  std::string text(const ClosedSurface& surface) const {
    return fmt::format("{} edges, the first from {} to {} m", count, vector_text<3>(surface.corner[first.low()]),
                       vector_text<3>(surface.corner[first.high()]));
  }
};

/// Numbers the edges.
void join(ClosedSurface& surface) {
  const std::vector<Side> sides = sides_of(surface);
  surface.edge.resize(surface.triangle.size());
  WrongEdges open;
  WrongEdges crowded;
  WrongEdges twisted;
  std::uint32_t edges = 0;
  for (std::size_t k = 0; k < sides.size(); ++edges) {
    std::size_t end = k;
    for (; end < sides.size() && sides[end].corners == sides[k].corners; ++end)
      surface.edge[sides[end].triangle][sides[end].number] = edges;
    if (end - k == 1) open.note(sides[k]);
    if (end - k > 2) crowded.note(sides[k]);
    if (end - k == 2 && sides[k].is_upward == sides[k + 1].is_upward) twisted.note(sides[k]);
    k = end;
  }
  surface.edge_normal.assign(edges, Vec<3>::Zero());
  if (open.count > 0)
    throw MeshError("the surface is not closed", "two triangles at every edge",
                    "one triangle at " + open.text(surface));
  if (crowded.count > 0)
    throw MeshError("the surface is not simple", "two triangles at every edge",
                    "more than two at " + crowded.text(surface));
  if (twisted.count > 0)
    throw MeshError("triangles that turn against their neighbours", "all counterclockwise seen from outside",
                    twisted.text(surface));
}

/// Six times the volume, about a corner so that it does not cancel far from the origin.
double signed_volume(const ClosedSurface& surface) {
  const Vec<3>& origin = surface.corner.front();
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangle) {
    const Vec<3> x = surface.corner[a] - origin;
    sum += x.dot((surface.corner[b] - origin).cross(surface.corner[c] - origin));
  }
  return sum / 6;
}

void turn_round(ClosedSurface& surface) {
  for (auto& corners : surface.triangle) std::swap(corners[1], corners[2]);
  for (auto& edges : surface.edge) std::swap(edges[0], edges[2]);  // a-b, b-c, c-a become a-c, c-b, b-a
}

Vec<3> unit_or_zero(const Vec<3>& v) {
  const double length = v.stableNorm();
  return length > 0 ? Vec<3>(v / length) : Vec<3>(Vec<3>::Zero());
}

double angle_between(const Vec<3>& a, const Vec<3>& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

void set_normals(ClosedSurface& surface) {
  surface.corner_normal.assign(surface.corner.size(), Vec<3>::Zero());
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const auto& corners = surface.triangle[t];
    std::array<Vec<3>, 3> side;
    for (std::size_t k = 0; k < 3; ++k) side[k] = surface.corner[corners[next(k)]] - surface.corner[corners[k]];
    const Vec<3> normal = unit_or_zero(side[0].cross(side[1]));
    surface.triangle_normal.push_back(normal);
    for (std::size_t k = 0; k < 3; ++k) {
      surface.edge_normal[surface.edge[t][k]] += normal;
      surface.corner_normal[corners[next(k)]] += angle_between(-side[k], side[next(k)]) * normal;
    }
  }
  for (Vec<3>& normal : surface.edge_normal) normal = unit_or_zero(normal);
  for (Vec<3>& normal : surface.corner_normal) normal = unit_or_zero(normal);
}

/// Below it a volume is what rounding leaves of zero.
double least_volume(const ClosedSurface& surface) {
  Eigen::AlignedBox3d box;
  for (const Vec<3>& x : surface.corner) box.extend(Eigen::Vector3d(x));
  return 1e-12 * std::pow(box.diagonal().norm(), 3);
}

}  // namespace

ClosedSurface close_surface(const Triangles& mesh, double scale, const Vec<3>& move) {
  ClosedSurface surface;
  weld(mesh, scale, move, surface);
  const std::string given = fmt::format("{} triangles", mesh.triangle.size());
  if (surface.triangle.empty()) throw MeshError("no volume", "a surface around a solid", given + " without area");
  join(surface);
  surface.volume = signed_volume(surface);
  if (!(std::abs(surface.volume) > least_volume(surface)))
    throw MeshError("no volume", "a surface around a solid",
                    fmt::format("{} around {:.3g} m^3", given, surface.volume));
  surface.was_inward = surface.volume < 0;
  if (surface.was_inward) turn_round(surface);
  surface.volume = std::abs(surface.volume);
  set_normals(surface);
  return surface;
}

}  // namespace minamo::shapes
