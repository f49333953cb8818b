#pragma once
/// \file
/// From what the parts of a scene have added to the lists that are the meaning of a run.

#include "systems/scene/scene.hpp"

namespace minamo {

struct Pipeline {
  std::vector<System> start;   ///< once, before the first step
  std::vector<System> step;    ///< every step
  std::size_t unrecorded = 0;  ///< so many systems, the first of them, in a step that the history has no row of
  std::vector<System> output;  ///< at every output time
};

/// \pre the scene was read without problems.
Pipeline make_pipeline(const Scene& scene);

}  // namespace minamo
