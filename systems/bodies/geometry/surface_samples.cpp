#include "systems/bodies/geometry/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace minamo {

namespace {

template <int Dim>
using Corners = std::array<Vec<Dim>, static_cast<std::size_t>(Dim)>;

/// The first end of the longest side.
template <int Dim>
std::size_t longest_side(const Corners<Dim>& corner) {
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t k = 0; k < Dim; ++k) {
    const double square = (corner[(k + 1) % Dim] - corner[k]).squaredNorm();
    if (square > most) longest = k;
    most = std::max(most, square);
  }
  return longest;
}

template <int Dim>
bool may_meet(const Corners<Dim>& corner, const Bounds<Dim>& box) {
  Bounds<Dim> of{corner[0], corner[0]};
  for (const Vec<Dim>& x : corner) of = {of.low.cwiseMin(x), of.high.cwiseMax(x)};
  return (of.low.array() <= box.high.array()).all() && (of.high.array() >= box.low.array()).all();
}

/// The middles of the parts of a segment or triangle whose sides are no longer than the spacing, by halving.
template <int Dim>
void add_parts(const Corners<Dim>& corner, const Bounds<Dim>& box, double spacing, std::vector<Vec<Dim>>& points) {
  if (!may_meet<Dim>(corner, box)) return;
  const std::size_t from = longest_side<Dim>(corner);
  const std::size_t to = (from + 1) % Dim;
  if ((corner[to] - corner[from]).norm() <= spacing) {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (const Vec<Dim>& x : corner) sum += x;
    points.push_back(sum / Dim);
    return;
  }
  Corners<Dim> first = corner;
  Corners<Dim> second = corner;
  first[to] = second[from] = 0.5 * (corner[from] + corner[to]);
  add_parts<Dim>(first, box, spacing, points);
  add_parts<Dim>(second, box, spacing, points);
}

/// Onto the surface from a point that is near it. A flat side stays as it is to the bit.
template <int Dim>
Vec<Dim> settled(const Shape<Dim>& shape, const Vec<Dim>& x, double least) {
  const double distance = shape.distance(x);
  if (std::abs(distance) <= least) return x;
  const Vec<Dim> gradient = shape.gradient(x);
  return x - distance / std::max(gradient.squaredNorm(), 0.01) * gradient;
}

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

}  // namespace

template <int Dim>
std::vector<Vec<Dim>> samples_of(const Shape<Dim>& shape, const Outline<Dim>& outline, const Bounds<Dim>& box,
                                 double spacing) {
  const double least = 1e-3 * spacing;
  std::vector<Vec<Dim>> points = outline.point;
  for (const auto& element : outline.element) {
    Corners<Dim> corner;
    for (std::size_t k = 0; k < Dim; ++k) corner[k] = outline.point[element[k]];
    add_parts<Dim>(corner, box, spacing, points);
  }
  // Segments and triangles of a curved surface lie within it.
  for (Vec<Dim>& x : points) x = settled<Dim>(shape, x, least);
  std::erase_if(points, [&](const Vec<Dim>& x) { return std::abs(shape.distance(x)) > 0.1 * spacing; });
  return points;
}

template <int Dim>
std::vector<std::size_t> groups_of(const std::vector<Vec<Dim>>& points, double distance) {
  std::vector<std::size_t> parent(points.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  std::map<Index<Dim>, std::vector<std::size_t>> in_cell;
  std::size_t around = 1;
  for (int d = 0; d < Dim; ++d) around *= 3;
  for (std::size_t k = 0; k < points.size(); ++k) {
    Index<Dim> cell;
    for (std::size_t d = 0; d < Dim; ++d)
      cell[d] = static_cast<int>(std::floor(points[k][static_cast<Eigen::Index>(d)] / distance));
    for (std::size_t n = 0; n < around; ++n) {
      Index<Dim> adjacent = cell;
      for (std::size_t d = 0, rest = n; d < Dim; ++d, rest /= 3) adjacent[d] += static_cast<int>(rest % 3) - 1;
      const auto found = in_cell.find(adjacent);
      if (found == in_cell.end()) continue;
      for (const std::size_t other : found->second) {
        if ((points[other] - points[k]).norm() > distance) continue;
        parent[root_of(parent, k)] = root_of(parent, other);
      }
    }
    in_cell[cell].push_back(k);
  }
  for (std::size_t k = 0; k < parent.size(); ++k) parent[k] = root_of(parent, k);
  return parent;
}

template std::vector<Vec<2>> samples_of<2>(const Shape<2>&, const Outline<2>&, const Bounds<2>&, double);
template std::vector<Vec<3>> samples_of<3>(const Shape<3>&, const Outline<3>&, const Bounds<3>&, double);
template std::vector<std::size_t> groups_of<2>(const std::vector<Vec<2>>&, double);
template std::vector<std::size_t> groups_of<3>(const std::vector<Vec<3>>&, double);

}  // namespace minamo
