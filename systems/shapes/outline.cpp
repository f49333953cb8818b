#include "systems/shapes/outline.hpp"

#include "systems/shapes/marching.hpp"
#include "systems/shapes/mesh.hpp"
#include "systems/shapes/polygon.hpp"
#include "systems/shapes/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace minamo {

namespace {

/// Samples along the longest side of what is sampled.
template <int Dim>
constexpr double fewest_samples = Dim == 2 ? 128 : 20;
template <int Dim>
constexpr double most_samples = Dim == 2 ? 1024 : 64;

Outline<2> loop_of(std::vector<Vec<2>> corners) {
  Outline<2> outline;
  const auto count = static_cast<std::uint32_t>(corners.size());
  for (std::uint32_t k = 0; k < count; ++k) outline.element.push_back({k, (k + 1) % count});
  outline.point = std::move(corners);
  return outline;
}

Outline<2> outline_of_box(const shapes::Box<2>& box) {
  return loop_of({box.corner({0, 0}), box.corner({1, 0}), box.corner({1, 1}), box.corner({0, 1})});
}

Outline<3> outline_of_box(const shapes::Box<3>& box) {
  Outline<3> outline;
  for (int k = 0; k < 8; ++k) outline.point.push_back(box.corner({k & 1, k >> 1 & 1, k >> 2}));
  outline.element = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return outline;
}

template <int Dim>
std::optional<Outline<Dim>> exact_outline(const Shape<Dim>& shape) {
  if (const auto* box = dynamic_cast<const shapes::Box<Dim>*>(&shape)) return outline_of_box(*box);
  if constexpr (Dim == 2) {
    if (const auto* polygon = dynamic_cast<const shapes::Polygon*>(&shape)) return loop_of(polygon->corners());
  } else {
    if (const auto* mesh = dynamic_cast<const shapes::Mesh*>(&shape))
      return Outline<3>{mesh->surface().corner, mesh->surface().triangle};
  }
  return {};
}

template <int Dim>
SampleNodes<Dim> nodes_around(const Bounds<Dim>& bounds, double spacing) {
  const double longest = (bounds.high - bounds.low).maxCoeff();
  const double sample = std::clamp(spacing, longest / most_samples<Dim>, longest / fewest_samples<Dim>);
  return SampleNodes<Dim>::around(bounds, sample);
}

/// What of the shape is in the box; all of it without a box.
template <int Dim>
SampledShape<Dim> sampled(const Shape<Dim>& shape, const shapes::Box<Dim>* box) {
  const auto is_of_box = [&shape, box](const Vec<Dim>& x) { return box && box->distance(x) > shape.distance(x); };
  return {[&shape, box](const Vec<Dim>& x) {
            return box ? std::max(shape.distance(x), box->distance(x)) : shape.distance(x);
          },
          [&shape, box, is_of_box](const Vec<Dim>& x) { return is_of_box(x) ? box->gradient(x) : shape.gradient(x); }};
}

template <int Dim>
Outline<Dim> sampled_outline(const Shape<Dim>& shape, const Bounds<Dim>& box, double spacing) {
  const shapes::Box<Dim> end(box.low, box.high);
  const bool is_endless = !shape.bounds().finite();
  const auto nodes = nodes_around<Dim>(is_endless ? box : shape.bounds(), spacing);
  const auto region = sampled<Dim>(shape, is_endless ? &end : nullptr);
  if constexpr (Dim == 2) {
    return march_squares(region, nodes);
  } else {
    return march_tetrahedra(region, nodes);
  }
}

}  // namespace

template <int Dim>
Outline<Dim> outline_of(const Shape<Dim>& shape, const Bounds<Dim>& box, double spacing) {
  auto exact = exact_outline<Dim>(shape);
  return exact ? std::move(*exact) : sampled_outline<Dim>(shape, box, spacing);
}

template <int Dim>
double outline_bytes(const Shape<Dim>& shape, const Bounds<Dim>& box, double spacing) {
  constexpr double number = 8;
  const auto bytes = [](double points, double elements) { return number * Dim * (points + elements); };
  if (const auto exact = exact_outline<Dim>(shape))
    return bytes(static_cast<double>(exact->point.size()), static_cast<double>(exact->element.size()));
  const bool is_endless = !shape.bounds().finite();
  const auto nodes = nodes_around<Dim>(is_endless ? box : shape.bounds(), spacing);
  const double along = *std::max_element(nodes.count.begin(), nodes.count.end());
  // Of the sides of a box in 3-D: a square has three points and six triangles.
  return Dim == 2 ? bytes(4 * along, 4 * along) : bytes(18 * along * along, 36 * along * along);
}

template Outline<2> outline_of<2>(const Shape<2>&, const Bounds<2>&, double);
template Outline<3> outline_of<3>(const Shape<3>&, const Bounds<3>&, double);
template double outline_bytes<2>(const Shape<2>&, const Bounds<2>&, double);
template double outline_bytes<3>(const Shape<3>&, const Bounds<3>&, double);

}  // namespace minamo
