#include "systems/bodies/geometry/placed_bodies.hpp"

namespace minamo {

template <int Dim>
PlacedBodies<Dim>::PlacedBodies(const BodySet<Dim>& set, std::span<const Vec<Dim>> position,
                                std::span<const Mat<Dim>> rotation, const DrySides<Dim>* dry)
    : set_(set), dry_(dry) {
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const auto& body = set.bodies[b];
    placement_.push_back({body.pivot, position[b], rotation[b]});
    (body.moves() ? moving_ : resting_).push_back(b);
    if (body.moves()) {
      Bounds<Dim> bounds = placement_.back().bounds(body.shape->bounds());
      if (dry != nullptr && dry->of_body[b]) {
        bounds.low.array() -= dry->of_body[b]->reach_of_dry();
        bounds.high.array() += dry->of_body[b]->reach_of_dry();
      }
      moving_bounds_.push_back(bounds);
    }
    bounded_ = bounded_ && body.shape->is_bounded_by_distance();
  }
}

template <int Dim>
PlacedBodies<Dim> PlacedBodies<Dim>::at_start(const BodySet<Dim>& set) {
  std::vector<Vec<Dim>> position;
  for (const auto& body : set.bodies) position.push_back(body.pivot);
  return {set, position, std::vector<Mat<Dim>>(set.bodies.size(), Mat<Dim>::Identity())};
}

template <int Dim>
typename PlacedBodies<Dim>::Nearest PlacedBodies<Dim>::nearest(const Vec<Dim>& x, bool moving,
                                                               const Index<Dim>* from) const {
  Nearest nearest;
  for (const std::size_t b : moving ? moving_ : resting_) {
    const Shape<Dim>& shape = *set_.bodies[b].shape;
    const Vec<Dim> in_body = placement_[b].to_body(x);
    double distance = shape.distance(in_body);
    if (dry_ != nullptr && dry_->of_body[b]) {
      const auto* view = from != nullptr ? dry_->view(b, *from) : nullptr;
      distance = dry_->of_body[b]->shaded(shape, in_body, distance, view);
    }
    if (distance < nearest.distance) nearest = {distance, static_cast<int>(b)};
  }
  return nearest;
}

template <int Dim>
bool PlacedBodies<Dim>::may_be_near(const Vec<Dim>& x, double reach) const {
  for (const Bounds<Dim>& bounds : moving_bounds_) {
    if (((x - bounds.low).array() > -reach).all() && ((bounds.high - x).array() > -reach).all()) return true;
  }
  return false;
}

template class PlacedBodies<2>;
template class PlacedBodies<3>;

}  // namespace minamo
