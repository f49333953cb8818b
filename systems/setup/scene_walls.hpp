#pragma once
/// \file
/// Reading of the walls: one name, one per axis, or one per side.

#include "systems/setup/scene.hpp"

namespace minamo {

/// `"slip"` for all sides, or per axis `{"x": "slip", "y": ["no_slip", "slip"]}`. Low and high side per axis.
std::vector<std::array<Wall, 2>> read_walls(Input& input, std::span<const int> cells);

}  // namespace minamo
