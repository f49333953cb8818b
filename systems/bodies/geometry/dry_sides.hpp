#pragma once
/// \file
/// (E136) Which side of a thin wall is dry: it counts as part of the body.

#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"

namespace minamo {

/// \return none if all walls of the bodies are thicker than splines of a degree reach
template <int Dim>
std::optional<DrySides<Dim>> dry_sides_of(const BodySet<Dim>& set, const Grid<Dim>& grid, int degree);

/// (E136) of the particles and bodies in the middle of the step.
template <int Dim>
struct FindDrySides {
  static constexpr Doc doc = "(E136) dry sides of thin walls";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Uses<BodyPlacement<Dim>> placement,
                  Read<StaticCut<Dim>> at_rest, Read<particle::QuadraturePosition<Dim>> y_p,
                  Optional<Read<Ranks>> ranks, Update<DrySides<Dim>> dry) const;
};

}  // namespace minamo
