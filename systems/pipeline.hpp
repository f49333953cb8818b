#pragma once
/// \file
/// The systems that a scene needs, in the order that is the meaning of a step.

#include "systems/setup/scene.hpp"

namespace minamo {

/// Slots of a step, in order. A scene's extra systems name one of them.
const std::vector<std::string>& slot_names();

struct Pipeline {
  std::vector<System> start;   ///< once, before the first step
  std::vector<System> step;    ///< every step
  std::vector<System> output;  ///< at every output time
};

/// \pre the scene was read without problems with the same registry.
Pipeline make_pipeline(const Scene& scene, const SystemRegistry& registry);

}  // namespace minamo
