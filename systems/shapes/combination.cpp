#include "systems/shapes/combination.hpp"

#include <algorithm>

namespace minamo::shapes {

namespace {

template <int Dim>
using Parts = std::optional<std::vector<ConvexPart<Dim>>>;

template <int Dim>
bool all_bounded(const std::vector<SharedShape<Dim>>& shapes) {
  return std::all_of(shapes.begin(), shapes.end(), [](const auto& shape) { return shape->is_bounded_by_distance(); });
}

/// The parts of all shapes, with faces numbered on from one shape to the next.
template <int Dim>
std::optional<std::vector<std::vector<ConvexPart<Dim>>>> numbered(const std::vector<SharedShape<Dim>>& shapes) {
  std::vector<std::vector<ConvexPart<Dim>>> all;
  int first = 0;
  for (const auto& shape : shapes) {
    auto parts = shape->convex_parts();
    if (!parts) return {};
    int last = first - 1;
    for (auto& part : *parts) {
      for (auto& facet : part) {
        if (facet.face == Facet<Dim>::inner) continue;
        facet.face += first;
        last = std::max(last, facet.face);
      }
    }
    first = last + 1;
    all.push_back(std::move(*parts));
  }
  return all;
}

/// Every part of the one with every part of the other.
template <int Dim>
Parts<Dim> common(const std::vector<ConvexPart<Dim>>& a, const std::vector<ConvexPart<Dim>>& b) {
  if (a.size() * b.size() > Shape<Dim>::most_parts) return {};
  std::vector<ConvexPart<Dim>> parts;
  for (const auto& of_a : a) {
    for (const auto& of_b : b) {
      parts.push_back(of_a);
      parts.back().insert(parts.back().end(), of_b.begin(), of_b.end());
    }
  }
  return parts;
}

/// Beyond the first facet, or beyond the second but not the first, and so on.
template <int Dim>
std::vector<ConvexPart<Dim>> outside(const ConvexPart<Dim>& part) {
  std::vector<ConvexPart<Dim>> parts;
  for (std::size_t k = 0; k < part.size(); ++k) {
    ConvexPart<Dim> beyond;
    for (std::size_t before = 0; before < k; ++before) {
      beyond.push_back(part[before]);
      beyond.back().face = Facet<Dim>::inner;
    }
    beyond.push_back({-part[k].normal, -part[k].offset, part[k].face});
    parts.push_back(std::move(beyond));
  }
  return parts;
}

}  // namespace

template <int Dim>
const Shape<Dim>& Union<Dim>::nearest(const Vec<Dim>& x) const {
  return **std::min_element(shapes_.begin(), shapes_.end(),
                            [&](const auto& a, const auto& b) { return a->distance(x) < b->distance(x); });
}

template <int Dim>
bool Union<Dim>::contains(const Vec<Dim>& x) const {
  return std::any_of(shapes_.begin(), shapes_.end(), [&](const auto& shape) { return shape->contains(x); });
}

template <int Dim>
Bounds<Dim> Union<Dim>::bounds() const {
  Bounds<Dim> bounds = shapes_.front()->bounds();
  for (const auto& shape : shapes_) {
    const auto one = shape->bounds();
    bounds = {bounds.low.cwiseMin(one.low), bounds.high.cwiseMax(one.high)};
  }
  return bounds;
}

template <int Dim>
bool Union<Dim>::is_bounded_by_distance() const {
  return all_bounded<Dim>(shapes_);
}

template <int Dim>
Parts<Dim> Union<Dim>::convex_parts() const {
  const auto all = numbered<Dim>(shapes_);
  if (!all) return {};
  std::vector<ConvexPart<Dim>> parts;
  for (const auto& of_one : *all) parts.insert(parts.end(), of_one.begin(), of_one.end());
  return parts.size() <= Shape<Dim>::most_parts ? Parts<Dim>(std::move(parts)) : std::nullopt;
}

template <int Dim>
const Shape<Dim>& Intersection<Dim>::farthest(const Vec<Dim>& x) const {
  return **std::max_element(shapes_.begin(), shapes_.end(),
                            [&](const auto& a, const auto& b) { return a->distance(x) < b->distance(x); });
}

template <int Dim>
bool Intersection<Dim>::contains(const Vec<Dim>& x) const {
  return std::all_of(shapes_.begin(), shapes_.end(), [&](const auto& shape) { return shape->contains(x); });
}

template <int Dim>
Bounds<Dim> Intersection<Dim>::bounds() const {
  Bounds<Dim> bounds;
  for (const auto& shape : shapes_) {
    const auto one = shape->bounds();
    bounds = {bounds.low.cwiseMax(one.low), bounds.high.cwiseMin(one.high)};
  }
  return bounds;
}

template <int Dim>
bool Intersection<Dim>::is_bounded_by_distance() const {
  return all_bounded<Dim>(shapes_);
}

template <int Dim>
Parts<Dim> Intersection<Dim>::convex_parts() const {
  const auto all = numbered<Dim>(shapes_);
  if (!all) return {};
  Parts<Dim> parts = all->front();
  for (std::size_t k = 1; k < all->size() && parts; ++k) parts = common<Dim>(*parts, (*all)[k]);
  return parts;
}

template <int Dim>
Parts<Dim> Complement<Dim>::convex_parts() const {
  const auto inside = shape_->convex_parts();
  if (!inside) return {};
  Parts<Dim> parts = std::vector<ConvexPart<Dim>>(1);  // everything
  for (const auto& part : *inside) {
    if (parts) parts = common<Dim>(*parts, outside<Dim>(part));
  }
  return parts;
}

template <int Dim>
SharedShape<Dim> difference(const std::vector<SharedShape<Dim>>& shapes) {
  std::vector<SharedShape<Dim>> all{shapes.front()};
  for (std::size_t k = 1; k < shapes.size(); ++k) all.push_back(std::make_shared<Complement<Dim>>(shapes[k]));
  return std::make_shared<Intersection<Dim>>(std::move(all));
}

template class Union<2>;
template class Union<3>;
template class Intersection<2>;
template class Intersection<3>;
template class Complement<2>;
template class Complement<3>;
template SharedShape<2> difference<2>(const std::vector<SharedShape<2>>&);
template SharedShape<3> difference<3>(const std::vector<SharedShape<3>>&);

}  // namespace minamo::shapes
