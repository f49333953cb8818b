#pragma once
/// \file
/// Where bodies are in the middle of the step, as one parameter of systems.

#include "components/body.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"

namespace minamo {

/// What PlacedBodies (geometry/placed_bodies.hpp) is made from.
template <int Dim>
struct BodyPlacement {
  Read<BodySet<Dim>> set;               ///< shapes
  Read<body::MiddlePosition<Dim>> c_b;  ///< [m]
  Read<body::MiddleRotation<Dim>> R_b;  ///< from the body to the grid
};

}  // namespace minamo
