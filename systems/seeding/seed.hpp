#pragma once
/// \file
/// Fills a world from a scene.

#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// Runs the seeds of all parts: constants, and the particles with what they carry.
/// \throws InputError with all that is wrong: shapes without particles, overlapping shapes, a velocity or body force
/// that is not finite, ...
void seed_world(const Scene& scene, const std::string& file, World& world);

}  // namespace minamo
