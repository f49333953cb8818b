#pragma once
/// \file
/// Surfaces of bodies for output.

#include "systems/bodies/body_set.hpp"
#include "systems/shapes/outline.hpp"

namespace minamo {

/// Of every body, where its shape is given. Made once, before the run.
template <int Dim>
struct BodyOutlines {
  struct OfBody {
    std::string name;
    Outline<Dim> outline;
    Vec<Dim> pivot = Vec<Dim>::Zero();  ///< [m]
    bool moves = false;
  };
  std::vector<OfBody> bodies;
  static constexpr ComponentInfo info{"bodies.outlines", "", "m", Lifetime::constant};
};

/// Endless bodies at rest end at the sides of the grid, moving ones where they cannot come into sight.
/// \param box      of the grid [m]
/// \param spacing  of the grid [m]
template <int Dim>
BodyOutlines<Dim> outlines_of(const BodySet<Dim>& set, const Bounds<Dim>& box, double spacing);

/// What they take, with the points as they are written, about. [byte]
template <int Dim>
double outlines_bytes(const BodySet<Dim>& set, const Bounds<Dim>& box, double spacing);

}  // namespace minamo
