#pragma once
/// \file
/// (E74) Bodies among the parts of cells on which stirring counts particles.

#include "components/body.hpp"
#include "components/cells.hpp"
#include "components/grid.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/volume/face_volume.hpp"

#include <cstdint>
#include <vector>

namespace minamo {

/// What bodies at rest fill of the parts of cells, found where particles have been.
struct RestingParts {
  std::vector<std::int32_t> place;  ///< of the window of a cell of the grid, x fastest, or one of these:
  static constexpr std::int32_t unknown = -2;
  static constexpr std::int32_t none = -1;
  std::vector<double> fill;  ///< of the parts of a window [1]
  static constexpr ComponentInfo info{"solid_parts.at_rest", "C_s", "1", Lifetime::cache};
};

/// (E74)  C_s, what bodies fill of the parts of the cells next to them, smoothed as particles are: near a plane wall it
/// is the integral of a quadratic B-spline of spacing d up to the distance.
template <int Dim>
struct FindSolidParts {
  static constexpr Doc doc = "(E74) C_s, what bodies fill of the parts of cells";
  void operator()(Read<Grid<Dim>> grid, Read<GridCells<Dim>> cells, Read<StirGrid> stir,
                  Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest, Update<RestingParts> resting,
                  Write<SolidParts> solid) const;
};

}  // namespace minamo
