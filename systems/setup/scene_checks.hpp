#pragma once
/// \file
/// What must hold between the keys of a scene, beyond the range of each.

#include "systems/setup/scene.hpp"

namespace minamo {

/// low < high, equal spacing, a size that fits into memory. Sets the spacing.
void check_grid(Input& input, GridScene& grid);

/// Boxes and balls lie inside the grid box.
void check_shape(Input& input, const std::variant<Box, Ball, Where>& shape, const GridScene& grid);

/// No constant hides x, y, z, t or pi.
void check_constants(Input& input, const std::map<std::string, double>& constants);

}  // namespace minamo
