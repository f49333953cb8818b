#pragma once
/// \file
/// How large a run of a scene is, told before anything is allocated for it.

#include "systems/scene/scene.hpp"

namespace minamo {

struct SceneSize {
  double places = 0;     ///< where a particle is looked for [1]
  double particles = 0;  ///< [1]
  double nodes = 0;      ///< with rows at the start [1]
  double all_nodes = 0;  ///< of the grid [1]
};

/// Boxes along the axes and balls are counted by their measure, other shapes at up to 2e4 places, all of them if there
/// are no more. \pre the scene was read without problems.
SceneSize size_of(const Scene& scene);

}  // namespace minamo
