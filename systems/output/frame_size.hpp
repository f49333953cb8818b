#pragma once
/// \file
/// What results take on the disk, told before there are any.

#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// A frame of as many particles as there are in fields.h5, with the points of bodies that move, and its part of
/// fields.xdmf; surfaces are not counted. [byte]
/// \pre the world was seeded with the scene, and the schedule of its step was made
double frame_bytes(const Scene& scene, World& world);

/// A checkpoint: all state. [byte] \pre as above
double checkpoint_bytes(World& world);

}  // namespace minamo
