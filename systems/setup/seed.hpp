#pragma once
/// \file
/// Fills a world from a scene: grid, walls, liquid, particles.

#include "engine/world.hpp"
#include "systems/setup/scene.hpp"

namespace minamo {

/// Creates what is constant during the run, and the particles with position, velocity and, where the scheme carries it,
/// velocity gradient. A lattice of `per_cell` particles per cell and direction is laid over the whole grid; those
/// inside a shape exist. Every particle has the mass of its share of a cell.
/// \throws InputError for shapes without particles, overlapping shapes, and a velocity or body force that is not
/// finite.
template <int Dim>
void seed_world(const Scene& scene, const std::string& file, World& world);

}  // namespace minamo
