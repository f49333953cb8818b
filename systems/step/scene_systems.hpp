#pragma once
/// \file
/// Whether the systems that a scene adds find what they read.

#include "systems/scene/scene.hpp"

namespace minamo {

/// A problem for every extra system that reads what no earlier system of the step writes, or that makes another one do
/// so, with the slots where it could stand.
/// \pre the scene was read without problems.
std::vector<Problem> misplaced_systems(const Scene& scene, const std::string& file);

}  // namespace minamo
