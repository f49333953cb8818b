#include "systems/shapes/marching.hpp"

#include "systems/shapes/crossings.hpp"

#include <cmath>
#include <optional>

namespace minamo {

namespace {

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// From every point to the next one, with what is inside to the left.
class Squares {
 public:
  Squares(const SampledShape<2>& shape, const SampleNodes<2>& nodes)
      : shape_(shape), nodes_(nodes), crossings_(shape, nodes) {}

  std::vector<std::uint32_t> link() {
    for (int j = 0; j + 1 < nodes_.count[1]; ++j) {
      for (int i = 0; i + 1 < nodes_.count[0]; ++i) link_in(i, j);
    }
    return std::move(next_);
  }
  std::vector<Vec<2>> points() const { return crossings_.points(); }

 private:
  /// Around a square counterclockwise lines begin where one leaves what is inside and end where one comes back.
  void link_in(int i, int j) {
    const auto width = static_cast<std::size_t>(nodes_.count[0]);
    const std::size_t first = static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i);
    const std::array<std::size_t, 4> corner{first, first + 1, first + width + 1, first + width};
    const auto leaves = [&](std::size_t k) {
      return crossings_.inside(corner[k % 4]) && !crossings_.inside(corner[(k + 1) % 4]);
    };
    const auto enters = [&](std::size_t k) {
      return !crossings_.inside(corner[k % 4]) && crossings_.inside(corner[(k + 1) % 4]);
    };
    const auto point_on = [&](std::size_t k) { return crossings_.between(corner[k % 4], corner[(k + 1) % 4]); };
    for (std::size_t from = 0; from < 4; ++from) {
      if (!leaves(from)) continue;
      // Two lines either cut off the corners outside, or those inside.
      const bool is_joined = leaves(from + 2) && is_inside_in_the_middle(first);
      std::size_t to = from + (is_joined ? 1 : 3);
      while (!enters(to)) to += is_joined ? 1 : 3;
      set_next(point_on(from), point_on(to));
    }
  }

  bool is_inside_in_the_middle(std::size_t first) const {
    return shape_.distance(nodes_.at(first) + Vec<2>::Constant(0.5 * nodes_.spacing)) <= 0;
  }

  void set_next(std::uint32_t from, std::uint32_t to) {
    if (next_.size() <= std::max(from, to)) next_.resize(std::max(from, to) + 1);
    next_[from] = to;
  }

  const SampledShape<2>& shape_;
  const SampleNodes<2>& nodes_;
  Crossings<2> crossings_;
  std::vector<std::uint32_t> next_;
};

/// Where the tangents of two points meet, if that is a corner of the shape.
std::optional<Vec<2>> corner_between(const SampledShape<2>& shape, const Vec<2>& a, const Vec<2>& b, double spacing) {
  constexpr double least_turn = 0.35;  // sine
  const Vec<2> n_a = shape.gradient(a);
  const Vec<2> n_b = shape.gradient(b);
  const double turn = cross(n_a, n_b);
  if (std::abs(turn) < least_turn * n_a.norm() * n_b.norm()) return {};
  const Vec<2> corner = a + n_b.dot(b - a) / turn * Vec<2>(-n_a[1], n_a[0]);
  const bool is_near = (corner - 0.5 * (a + b)).norm() < spacing;
  return is_near && std::abs(shape.distance(corner)) < 1e-4 * spacing ? std::optional(corner) : std::nullopt;
}

/// Without the points on straight lines.
std::vector<Vec<2>> straightened(const std::vector<Vec<2>>& loop, double spacing) {
  std::vector<Vec<2>> kept;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec<2>& before = kept.empty() ? loop.back() : kept.back();
    const Vec<2>& after = loop[(k + 1) % loop.size()];
    const Vec<2> along = after - before;
    const bool is_on_line = std::abs(cross(loop[k] - before, along)) <= 1e-7 * spacing * along.norm();
    if (!is_on_line) kept.push_back(loop[k]);
  }
  return kept.size() < 3 ? loop : kept;
}

void add_loop(const std::vector<Vec<2>>& loop, Outline<2>& outline) {
  const auto first = static_cast<std::uint32_t>(outline.point.size());
  const auto count = static_cast<std::uint32_t>(loop.size());
  outline.point.insert(outline.point.end(), loop.begin(), loop.end());
  for (std::uint32_t k = 0; k < count; ++k) outline.element.push_back({first + k, first + (k + 1) % count});
}

}  // namespace

Outline<2> march_squares(const SampledShape<2>& shape, const SampleNodes<2>& nodes) {
  Squares squares(shape, nodes);
  const auto next = squares.link();
  const auto points = squares.points();
  Outline<2> outline;
  std::vector<bool> seen(points.size(), false);
  for (std::uint32_t start = 0; start < points.size(); ++start) {
    std::vector<Vec<2>> loop;
    for (std::uint32_t k = start; !seen[k]; k = next[k]) {
      seen[k] = true;
      loop.push_back(points[k]);
      if (const auto corner = corner_between(shape, points[k], points[next[k]], nodes.spacing)) loop.push_back(*corner);
    }
    if (loop.size() > 2) add_loop(straightened(loop, nodes.spacing), outline);
  }
  return outline;
}

}  // namespace minamo
