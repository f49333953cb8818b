#include "systems/shapes/mesh.hpp"

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include <array>
#include <cmath>
#include <utility>

namespace minamo::shapes {

namespace {

using AlignedBox = Eigen::AlignedBox3d;

/// Of a triangle the part that a point of it belongs to.
struct FootOnTriangle {
  Vec<3> point = Vec<3>::Zero();
  Vec<3> normal = Vec<3>::Zero();  ///< of the triangle, edge or corner that the point is on
  double squared = std::numeric_limits<double>::infinity();
  bool is_on_triangle = false;  ///< and not on an edge or a corner
};

/// The nearest point of a triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
FootOnTriangle foot_on(const ClosedSurface& surface, std::uint32_t t, const Vec<3>& x) {
  const auto& corners = surface.triangle[t];
  const Vec<3>&a = surface.corner[corners[0]], &b = surface.corner[corners[1]], &c = surface.corner[corners[2]];
  const Vec<3> ab = b - a;
  const Vec<3> ac = c - a;
  const auto at = [&](const Vec<3>& point, const Vec<3>& normal, bool is_on_triangle = false) {
    return FootOnTriangle{point, normal, (x - point).squaredNorm(), is_on_triangle};
  };
  const auto at_corner = [&](std::size_t k) {
    return at(surface.corner[corners[k]], surface.corner_normal[corners[k]]);
  };
  const auto on_edge = [&](std::size_t k, const Vec<3>& point) {
    return at(point, surface.edge_normal[surface.edge[t][k]]);
  };
  const double ab_a = ab.dot(x - a);
  const double ac_a = ac.dot(x - a);
  if (ab_a <= 0 && ac_a <= 0) return at_corner(0);
  const double ab_b = ab.dot(x - b);
  const double ac_b = ac.dot(x - b);
  if (ab_b >= 0 && ac_b <= ab_b) return at_corner(1);
  const double part_c = ab_a * ac_b - ab_b * ac_a;
  if (part_c <= 0 && ab_a >= 0 && ab_b <= 0) return on_edge(0, a + ab_a / (ab_a - ab_b) * ab);
  const double ab_c = ab.dot(x - c);
  const double ac_c = ac.dot(x - c);
  if (ac_c >= 0 && ab_c <= ac_c) return at_corner(2);
  const double part_b = ab_c * ac_a - ab_a * ac_c;
  if (part_b <= 0 && ac_a >= 0 && ac_c <= 0) return on_edge(2, a + ac_a / (ac_a - ac_c) * ac);
  const double part_a = ab_b * ac_c - ab_c * ac_b;
  const double to_c = ac_b - ab_b;
  const double to_b = ab_c - ac_c;
  if (part_a <= 0 && to_c >= 0 && to_b >= 0) return on_edge(1, b + to_c / (to_c + to_b) * (c - b));
  const double sum = part_a + part_b + part_c;
  return at(a + part_b / sum * ab + part_c / sum * ac, surface.triangle_normal[t], true);
}

double sign(const FootOnTriangle& foot, const Vec<3>& x) { return foot.normal.dot(x - foot.point) < 0 ? -1 : 1; }

}  // namespace

struct Mesh::Tree {
  Eigen::KdBVH<double, 3, std::uint32_t> boxes;

  explicit Tree(const ClosedSurface& surface) {
    std::vector<std::uint32_t> triangles;
    std::vector<AlignedBox> box;
    for (std::uint32_t t = 0; t < surface.triangle.size(); ++t) {
      triangles.push_back(t);
      box.emplace_back();
      for (const std::uint32_t corner : surface.triangle[t]) box.back().extend(Eigen::Vector3d(surface.corner[corner]));
    }
    boxes.init(triangles.begin(), triangles.end(), box.begin(), box.end());
  }

  FootOnTriangle nearest(const ClosedSurface& surface, const Vec<3>& x) const {
    FootOnTriangle best;
    search(boxes.getRootIndex(), surface, x, best);
    return best;
  }

 private:
  /// What is in the nearer of two boxes first, so that the other is seldom opened. Eigen's own search keeps a queue,
  /// for which it allocates.
  void search(int node, const ClosedSurface& surface, const Vec<3>& x, FootOnTriangle& best) const {
    const int* box = nullptr;
    const int* box_end = nullptr;
    const std::uint32_t* triangle = nullptr;
    const std::uint32_t* triangle_end = nullptr;
    boxes.getChildren(node, box, box_end, triangle, triangle_end);
    for (; triangle != triangle_end; ++triangle) {
      const FootOnTriangle foot = foot_on(surface, *triangle, x);
      if (foot.squared < best.squared) best = foot;  // not so a foot that is not a number, of a triangle without area
    }
    std::array<std::pair<double, int>, 2> inner;
    std::size_t count = 0;
    for (; box != box_end; ++box)
      inner[count++] = {boxes.getVolume(*box).squaredExteriorDistance(Eigen::Vector3d(x)), *box};
    if (count == 2 && inner[1].first < inner[0].first) std::swap(inner[0], inner[1]);
    for (std::size_t k = 0; k < count; ++k) {
      if (inner[k].first < best.squared) search(inner[k].second, surface, x, best);
    }
  }
};

Mesh::Mesh(ClosedSurface surface) : surface_(std::move(surface)), tree_(std::make_unique<Tree>(surface_)) {}
Mesh::~Mesh() = default;

double Mesh::distance(const Vec<3>& x) const {
  const FootOnTriangle foot = tree_->nearest(surface_, x);
  return sign(foot, x) * std::sqrt(foot.squared);
}

Vec<3> Mesh::gradient(const Vec<3>& x) const {
  const FootOnTriangle foot = tree_->nearest(surface_, x);
  // The difference of two close points has no direction to speak of.
  const double size = std::max(x.cwiseAbs().maxCoeff(), foot.point.cwiseAbs().maxCoeff());
  if (foot.is_on_triangle || foot.squared < std::pow(1e-9 * size, 2)) return foot.normal;
  return sign(foot, x) * (x - foot.point).stableNormalized();
}

Bounds<3> Mesh::bounds() const {
  Bounds<3> bounds{surface_.corner[0], surface_.corner[0]};
  for (const Vec<3>& x : surface_.corner) bounds = {bounds.low.cwiseMin(x), bounds.high.cwiseMax(x)};
  return bounds;
}

}  // namespace minamo::shapes
