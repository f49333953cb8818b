#pragma once
/// \file
/// A shape by an expression.

#include "components/instant.hpp"
#include "systems/shapes/shape.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

namespace minamo::shapes {

/// Where an expression in x, y, z, t and the ode variables is negative, at one instant; its value is taken for the
/// distance. Where it is not finite, the distance is infinite: outside.
template <int Dim>
class LevelSet : public Shape<Dim> {
 public:
  LevelSet(const Expression& distance, const Instant& instant) : expression_(distance), instant_(instant) {}

  double distance(const Vec<Dim>& x) const override;
  Bounds<Dim> bounds() const override { return {}; }
  bool is_bounded_by_distance() const override { return false; }

 private:
  mutable tbb::enumerable_thread_specific<Expression> expression_;  ///< one object is not for several threads
  Instant instant_;
};

}  // namespace minamo::shapes
