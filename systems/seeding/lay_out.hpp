#pragma once
/// \file
/// Where the particles of a scene are at the start.

#include "systems/bodies/geometry/seed_cut.hpp"
#include "systems/scene/parts.hpp"

namespace minamo {

/// The particles of all regions, on several ranks those of its share of the layers of cells. Notes regions that are
/// empty or overlap.
template <int Dim>
Seeds<Dim> lay_out(const Scene& scene, const Grid<Dim>& grid, World& world, SeedProblems& problems);

}  // namespace minamo
