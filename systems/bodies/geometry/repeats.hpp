#pragma once
/// \file
/// Bodies next to the ends of periodic axes. A body is where it is and has no images: at both ends it must look the
/// same.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"

#include <optional>

namespace minamo {

/// How near to an end a body may not come without being the same at the other one. [m]
template <int Dim>
double reach_over_ends(const Grid<Dim>& grid, const Splines<Dim>& splines) {
  return splines.degree * grid.spacing;
}

/// \return a periodic axis at whose ends a body is not the same, if there is one
template <int Dim>
std::optional<std::size_t> axis_where_it_ends(const Shape<Dim>& shape, const Placement<Dim>& placement,
                                              const Grid<Dim>& grid, double reach);

/// \throws std::runtime_error naming the body that has come to the end of a periodic axis
template <int Dim>
struct RequireRepeats {
  static constexpr Doc doc = "stop the run if a body comes to the end of a periodic axis";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                  Uses<BodyPlacement<Dim>> placement) const;
};

}  // namespace minamo
