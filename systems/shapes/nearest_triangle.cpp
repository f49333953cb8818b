#include "systems/shapes/nearest_triangle.hpp"

#include "engine/schedule/parallel.hpp"

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace minamo::shapes {

namespace {

using AlignedBox = Eigen::AlignedBox3d;

/// Voxels along the longest side of the surface. With more the lists are shorter and take longer to make.
constexpr double voxels_along = 32;
/// Of more triangles than this none are listed: most voxels would have too many.
constexpr std::size_t most_triangles = 5000;
/// A voxel with more is searched in the tree.
constexpr std::size_t most_listed = 32;
/// How far voxels reach beyond the surface, as a share of its longest side.
constexpr double margin = 0.125;

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

void take_nearest(const ClosedSurface& surface, std::span<const std::uint32_t> triangles, const Vec<3>& x,
                  FootOnTriangle& best) {
  for (const std::uint32_t t : triangles) {
    const FootOnTriangle foot = foot_on(surface, t, x);
    if (foot.squared < best.squared) best = foot;  // not so a foot that is not a number, of a triangle without area
  }
}

}  // namespace

struct NearestTriangle::Tree {
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
  /// Adds the triangles within a distance of a point, until there are more than so many.
  void collect(int node, const ClosedSurface& surface, const Vec<3>& x, double within, std::size_t most,
               std::vector<std::uint32_t>& found) const {
    if (found.size() > most) return;
    const auto [inner, triangles] = children(node);
    for (const std::uint32_t t : triangles) {
      if (foot_on(surface, t, x).squared <= within * within) found.push_back(t);
    }
    for (const int box : inner) {
      if (squared_distance(box, x) <= within * within) collect(box, surface, x, within, most, found);
    }
  }

 private:
  /// Of a box: those in it, and the triangles in no smaller one.
  std::pair<std::span<const int>, std::span<const std::uint32_t>> children(int node) const {
    const int* box = nullptr;
    const int* box_end = nullptr;
    const std::uint32_t* triangle = nullptr;
    const std::uint32_t* triangle_end = nullptr;
    boxes.getChildren(node, box, box_end, triangle, triangle_end);
    return {{box, box_end}, {triangle, triangle_end}};
  }
  double squared_distance(int box, const Vec<3>& x) const {
    return boxes.getVolume(box).squaredExteriorDistance(Eigen::Vector3d(x));
  }
  /// What is in the nearer of two boxes first, so that the other is seldom opened. Eigen's own search keeps a queue,
  /// for which it allocates.
  void search(int node, const ClosedSurface& surface, const Vec<3>& x, FootOnTriangle& best) const {
    const auto [boxes_in, triangles] = children(node);
    take_nearest(surface, triangles, x, best);
    std::array<std::pair<double, int>, 2> inner;
    std::size_t count = 0;
    for (const int box : boxes_in) inner[count++] = {squared_distance(box, x), box};
    if (count == 2 && inner[1].first < inner[0].first) std::swap(inner[0], inner[1]);
    for (std::size_t k = 0; k < count; ++k) {
      if (inner[k].first < best.squared) search(inner[k].second, surface, x, best);
    }
  }
};
;

NearestTriangle::NearestTriangle(const ClosedSurface& surface) : tree_(std::make_unique<Tree>(surface)) {
  if (surface.triangle.size() <= most_triangles) list_triangles(surface);
}
NearestTriangle::~NearestTriangle() = default;

FootOnTriangle NearestTriangle::operator()(const ClosedSurface& surface, const Vec<3>& x) const {
  const auto listed = listed_at(x);
  if (listed.empty()) return tree_->nearest(surface, x);
  FootOnTriangle best;
  take_nearest(surface, listed, x, best);
  return best;
}

std::span<const std::uint32_t> NearestTriangle::listed_at(const Vec<3>& x) const {
  if (triangle_.empty()) return {};
  std::size_t voxel = 0;
  for (std::size_t d = 3; d-- > 0;) {
    const auto axis = static_cast<Eigen::Index>(d);
    const double along = (x[axis] - low_[axis]) / side_;
    if (!(along >= 0 && along < count_[d])) return {};
    voxel = voxel * static_cast<std::size_t>(count_[d]) + static_cast<std::size_t>(along);
  }
  return std::span(triangle_).subspan(start_[voxel], start_[voxel + 1] - start_[voxel]);
}

// What is nearest to some point of a voxel is no farther from its middle than what is nearest to that, and its
// diagonal.
void NearestTriangle::list_triangles(const ClosedSurface& surface) {
  // Files may have corners that no triangle has.
  Vec<3> high = low_ = surface.corner[surface.triangle[0][0]];
  for (const auto& corners : surface.triangle) {
    for (const std::uint32_t corner : corners) {
      low_ = low_.cwiseMin(surface.corner[corner]);
      high = high.cwiseMax(surface.corner[corner]);
    }
  }
  const double longest = (high - low_).maxCoeff();
  low_ -= Vec<3>::Constant(margin * longest);
  high += Vec<3>::Constant(margin * longest);
  side_ = longest / voxels_along;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    count_[d] = static_cast<int>(std::ceil((high[axis] - low_[axis]) / side_));
  }
  const auto across = static_cast<std::size_t>(count_[0]);
  const std::size_t in_plane = across * static_cast<std::size_t>(count_[1]);
  std::vector<std::vector<std::uint32_t>> of_voxel(in_plane * static_cast<std::size_t>(count_[2]));
  const double diagonal = std::sqrt(3.0) * side_;
  for_each_row(of_voxel.size(), [&](std::size_t v) {
    const Vec<3> place(static_cast<double>(v % across),
                       static_cast<double>(v / across % static_cast<std::size_t>(count_[1])),
                       static_cast<double>(v / in_plane));
    const Vec<3> middle = low_ + side_ * (place + Vec<3>::Constant(0.5));
    const double distance = std::sqrt(tree_->nearest(surface, middle).squared);
    if (distance > margin * longest) return;
    constexpr double rounding = 1e-9;
    std::vector<std::uint32_t> found;
    tree_->collect(tree_->boxes.getRootIndex(), surface, middle, distance + (1 + rounding) * diagonal, most_listed,
                   found);
    if (found.size() <= most_listed) of_voxel[v] = std::move(found);
  });
  start_.assign(1, 0);
  for (const auto& triangles : of_voxel) {
    triangle_.insert(triangle_.end(), triangles.begin(), triangles.end());
    start_.push_back(static_cast<std::uint32_t>(triangle_.size()));
  }
}

}  // namespace minamo::shapes
