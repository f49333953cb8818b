#pragma once
/// \file
/// Places of particles at the start.

#include "components/grid.hpp"
#include "components/instant.hpp"
#include "systems/scene/scene.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace minamo {

/// Where in its part of a cell a particle of a lattice lies: in the middle, or next to walls where a sum over particles
/// is the integral, (E70): of the basis of equal order, or of quadratic splines with open knots.
enum class LatticePlaces { middle_of_parts, nearer_to_walls, exact_for_splines };

/// The cell (not dual cell) of a point inside the box, by its lowest node.
template <int Dim>
Index<Dim> cell_of(const Grid<Dim>& grid, const Vec<Dim>& x);

/// Which parts of cells a region of liquid takes: those with the middle inside, or all that may reach into it.
enum class PartsTaken { middle_inside, within_reach };

/// Layers of cells along the last axis, first and past the last.
using Layers = std::array<int, 2>;

/// Those that a region may reach into.
template <int Dim>
Layers layers_of(const ParticleScene& region, const Grid<Dim>& grid);

/// The particles of a region: per_cell^d in every cell, at the middles of equal parts, or anywhere in these parts if
/// jittered; those inside the shape, or, of a shape with a distance, all that may reach into it. Cells and parts come
/// in the order of the grid, x fastest. `start` is what the expression of a shape sees of time and ode variables. A
/// middle on the surface is inside, whatever rounding says, so that a mirrored shape has the mirrored particles. \param
/// layers   no others are looked at; what they have is the same as without \param earlier  regions that have had the
/// particles on surfaces in common
template <int Dim>
std::vector<Vec<Dim>> lattice(const ParticleScene& region, const Grid<Dim>& grid, const Instant& start = {},
                              PartsTaken taken = PartsTaken::middle_inside,
                              const Layers& layers = {0, std::numeric_limits<int>::max()},
                              std::span<const ParticleScene> earlier = {});

/// (E70)  x of a lattice of n per cell and direction; in the cells at walls moved so that the sums of the quadratic
/// splines are their integrals. One particle per cell and direction moves nearer to the wall alone.
template <int Dim>
Vec<Dim> exact_for_splines(const Grid<Dim>& grid, int per_cell, Vec<Dim> x);

/// (E70)  x of a lattice of n per cell and direction; if it is of a row next to a wall, h/(24 n) nearer to the wall.
template <int Dim>
Vec<Dim> nearer_to_walls(const Grid<Dim>& grid, int per_cell, Vec<Dim> x);

}  // namespace minamo
