#include "systems/shapes/polygon.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace minamo::shapes {

namespace {

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Twice the area of a triangle, positive if it turns to the left. Zero to the bit for corners on a line along an axis.
double turn(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) { return cross(b - a, c - a); }

/// Of the fan about the first corner, so that a polygon far from the origin does not cancel.
double twice_area(std::span<const Vec<2>> corners) {
  double sum = 0;
  for (std::size_t k = 2; k < corners.size(); ++k) sum += turn(corners[0], corners[k - 1], corners[k]);
  return sum;
}

/// The next one around a ring.
std::size_t after(std::size_t k, std::size_t count) { return k + 1 < count ? k + 1 : 0; }

struct FootOnEdge {
  double squared = std::numeric_limits<double>::infinity();  ///< distance
  Vec<2> point = Vec<2>::Zero();
  std::size_t side = 0;
  bool is_corner = false;
};

FootOnEdge nearest(std::span<const Vec<2>> corners, const Vec<2>& x) {
  FootOnEdge best;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec<2> along = corners[after(k, corners.size())] - corners[k];
    const double share = std::clamp((x - corners[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vec<2> point = corners[k] + share * along;
    const double squared = (x - point).squaredNorm();
    if (squared < best.squared) best = {squared, point, k, share == 0 || share == 1};
  }
  return best;
}

Vec<2> outward(const Vec<2>& from, const Vec<2>& to) { return Vec<2>(to[1] - from[1], from[0] - to[0]).normalized(); }

bool is_between(const Vec<2>& x, const Vec<2>& a, const Vec<2>& b) {
  return (x.array() >= a.cwiseMin(b).array()).all() && (x.array() <= a.cwiseMax(b).array()).all();
}

/// Whether two segments have a point in common.
bool meet(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const double abc = turn(a, b, c);
  const double abd = turn(a, b, d);
  const double cda = turn(c, d, a);
  const double cdb = turn(c, d, b);
  if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) return true;
  return (abc == 0 && is_between(c, a, b)) || (abd == 0 && is_between(d, a, b)) || (cda == 0 && is_between(a, c, d)) ||
         (cdb == 0 && is_between(b, c, d));
}

std::string text(const Vec<2>& x) { return fmt::format("[{}, {}]", x[0], x[1]); }

/// The first two sides that have more in common than the corner between them.
std::optional<std::array<std::size_t, 2>> sides_that_meet(std::span<const Vec<2>> corners) {
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec<2>&a = corners[i], &b = corners[after(i, count)];
    for (std::size_t j = i + 1; j < count; ++j) {
      const Vec<2>&c = corners[j], &d = corners[after(j, count)];
      const bool is_next = j == i + 1;
      const bool is_previous = after(j, count) == i;
      const bool folds_back = (is_next && turn(a, b, d) == 0 && (d - b).dot(a - b) > 0) ||
                              (is_previous && turn(c, d, b) == 0 && (b - d).dot(c - d) > 0);
      if (is_next || is_previous ? folds_back : meet(a, b, c, d)) return std::array{i, j};
    }
  }
  return {};
}

/// Cuts triangles off until one is left.
class Ears {
 public:
  explicit Ears(std::span<const Vec<2>> corners) : corners_(corners), left_(corners.size()) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
  }

  std::vector<std::array<std::size_t, 3>> cut_all() {
    std::vector<std::array<std::size_t, 3>> ears;
    while (left_.size() > 3) ears.push_back(cut());
    ears.push_back({left_[0], left_[1], left_[2]});
    return ears;
  }

 private:
  std::array<std::size_t, 3> triangle(std::size_t middle) const {
    const std::size_t count = left_.size();
    return {left_[middle > 0 ? middle - 1 : count - 1], left_[middle], left_[after(middle, count)]};
  }
  bool is_ear(const std::array<std::size_t, 3>& ear) const {
    const Vec<2>&a = corners_[ear[0]], &b = corners_[ear[1]], &c = corners_[ear[2]];
    if (turn(a, b, c) <= 0) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::size_t k) {
      const Vec<2>& x = corners_[k];
      const bool is_corner = k == ear[0] || k == ear[1] || k == ear[2];
      return !is_corner && turn(a, b, x) >= 0 && turn(b, c, x) >= 0 && turn(c, a, x) >= 0;
    });
  }
  /// An ear, or a corner on a line, or by rounding any corner.
  std::array<std::size_t, 3> cut() {
    std::size_t chosen = 0;
    for (std::size_t k = 0; k < left_.size(); ++k) {
      const auto at = triangle(k);
      if (!is_ear(at)) continue;
      chosen = k;
      break;
    }
    const auto ear = triangle(chosen);
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(chosen));
    return ear;
  }

  std::span<const Vec<2>> corners_;
  std::vector<std::size_t> left_;
};

}  // namespace

Polygon::Polygon(std::vector<Vec<2>> corners) : corners_(std::move(corners)), is_reversed_(twice_area(corners_) < 0) {
  if (is_reversed_) std::reverse(corners_.begin(), corners_.end());
}

double Polygon::distance(const Vec<2>& x) const {
  const double distance = std::sqrt(nearest(corners_, x).squared);
  return contains(x) ? -distance : distance;
}

bool Polygon::contains(const Vec<2>& x) const {
  bool inside = false;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    const Vec<2>&a = corners_[k], &b = corners_[after(k, corners_.size())];
    if ((a[1] > x[1]) == (b[1] > x[1])) continue;
    const bool is_left = b[1] > a[1] ? turn(a, b, x) > 0 : turn(a, b, x) < 0;
    if (is_left) inside = !inside;
  }
  return inside;
}

Vec<2> Polygon::gradient(const Vec<2>& x) const {
  const FootOnEdge foot = nearest(corners_, x);
  const Vec<2>&from = corners_[foot.side], &to = corners_[after(foot.side, corners_.size())];
  // The difference of two close points has no direction to speak of; that of a side is known.
  if (!foot.is_corner || foot.squared == 0) return outward(from, to);
  const Vec<2> away = (x - foot.point).normalized();
  return contains(x) ? Vec<2>(-away) : away;
}

Bounds<2> Polygon::bounds() const {
  Bounds<2> bounds{corners_[0], corners_[0]};
  for (const Vec<2>& corner : corners_) {
    bounds.low = bounds.low.cwiseMin(corner);
    bounds.high = bounds.high.cwiseMax(corner);
  }
  return bounds;
}

std::optional<std::vector<ConvexPart<2>>> Polygon::convex_parts() const {
  const std::size_t count = corners_.size();
  if (count > 1000) return {};  // ears take the square of it, and more
  const auto face_of = [&](std::size_t from, std::size_t to) {
    if (after(from, count) != to) return Facet<2>::inner;
    // Side k reversed: from corner count - 1 - k as given to the one before.
    const std::size_t given = is_reversed_ ? (2 * count - 2 - from) % count : from;
    return static_cast<int>(given);
  };
  std::vector<ConvexPart<2>> parts;
  for (const auto& ear : Ears(corners_).cut_all()) {
    if (turn(corners_[ear[0]], corners_[ear[1]], corners_[ear[2]]) <= 0) continue;  // corners on a line
    ConvexPart<2> part;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = ear[k];
      const std::size_t to = ear[after(k, 3)];
      const Vec<2> normal = outward(corners_[from], corners_[to]);
      part.push_back({normal, normal.dot(corners_[from]), face_of(from, to)});
    }
    parts.push_back(part);
  }
  return parts;
}

std::optional<PolygonProblem> what_is_wrong(std::span<const Vec<2>> corners) {
  if (corners.size() < 3) return PolygonProblem{"too few corners", fmt::format("{} corners", corners.size())};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t next = after(k, corners.size());
    if (corners[k] != corners[next]) continue;
    return PolygonProblem{"a corner given twice", fmt::format("corners {} and {} at {} m", k, next, text(corners[k]))};
  }
  if (const auto sides = sides_that_meet(corners)) {
    return PolygonProblem{"the polygon meets itself",
                          fmt::format("the side from corner {} at {} m and the one from corner {} at {} m", (*sides)[0],
                                      text(corners[(*sides)[0]]), (*sides)[1], text(corners[(*sides)[1]]))};
  }
  if (!std::isnormal(twice_area(corners))) return PolygonProblem{"the polygon has no area", "corners on a line"};
  return {};
}

}  // namespace minamo::shapes
