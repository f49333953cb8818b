#pragma once
/// \file
/// What a run needs of memory, estimated before it begins. What there is of it is not here.

#include "systems/step/scene_size.hpp"

namespace minamo {

/// Largest memory that a run will have taken when it ends, estimated: so much for the program, per particle, per
/// node with a row, and for the surfaces of bodies. The numbers are fitted to runs of 256 to a million particles, whole
/// dam breaks among them: the estimate is 1.04 to 2.4 times what they took with the block solver (honey, which is slow
/// to wet more nodes: 2 to 4 times), 1.3 to 3.3 times with UMFPACK. [byte]
double memory_of(const Scene& scene, const SceneSize& at_start);

/// Particles per cell and direction of the thinnest region. [1]
int fewest_per_cell(const Scene& scene);

}  // namespace minamo
