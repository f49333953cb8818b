#pragma once
/// \file
/// The discretization of a scene.

#include "systems/scene/scene.hpp"

namespace minamo {

/// Equal order: velocity and pressure on the nodes of the grid, stabilized. Conforming: velocities on faces, free of
/// divergence at every point.
struct Discretization {
  bool is_conforming = false;
  int degree = 2;  ///< of the splines of conforming velocities along themselves
};

/// False also where its name is unknown: that problem is noted, and the rest of the scene is still read.
inline bool is_conforming(const Scene& scene) {
  const auto* discretization = scene.facts.find<Discretization>();
  return discretization != nullptr && discretization->is_conforming;
}

}  // namespace minamo
