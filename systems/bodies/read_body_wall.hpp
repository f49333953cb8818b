#pragma once
/// \file
/// What a scene says of the surface of a body.

#include "engine/input/input.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/scene/scene.hpp"
#include "systems/viscosity/friction_choice.hpp"

namespace minamo {

/// Under "wall": "slip", "no_slip" or {"slip_length": m}; slip without it.
BodyWall read_body_wall(Input& input, const Scene& scene);

/// Slip lengths that a thick liquid does not tell from none. [h]
inline constexpr double sticks_below = 0.1;

/// What the grid makes of it. A liquid that flows easily has a film along the wall that is much thinner than a cell: no
/// slip is a slip length of 0.05 h there, or the wall would stop all of the cell. A thick liquid sticks to the wall
/// where the slip length is less than 0.1 h, and slips by 0.2 h at least where it is more: a shorter one makes friction
/// so stiff that along the wall the midpoint rule lets the liquid swing.
BodyWall wall_on_grid(const BodyWall& wall, Friction friction, double spacing);

}  // namespace minamo
