#pragma once
/// \file
/// Patches: the pressure on parts of the surfaces of bodies, as columns of the history.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/splines.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/shapes/outline.hpp"

namespace minamo {

template <int Dim>
struct Patches {
  /// A piece of the surface, where the shape is given.
  struct Piece {
    Vec<Dim> middle = Vec<Dim>::Zero();  ///< [m]
    Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, out of the body [1]
    double area = 0;                     ///< [m^2; m in 2-D]
  };
  struct Patch {
    std::string name;  ///< begins its columns
    std::size_t body = 0;
    SharedShape<Dim> within;    ///< null: all of the surface
    std::vector<Piece> pieces;  ///< of the surface within, at the start
  };
  std::vector<Patch> patches;
  static constexpr ComponentInfo info{"patches", "", "m", Lifetime::constant};
};

/// Elements of an outline in pieces.
/// \param size  of a piece at most, about [m]
template <int Dim>
std::vector<typename Patches<Dim>::Piece> pieces_of(const Outline<Dim>& outline, double size);

/// (E139)  NAME_pressure, the mean over the patch, and NAME_force_x, ..., of the pressure alone. What of a patch lies
/// outside of the box or in another body does not count; where it is dry the pressure is zero.
template <int Dim>
struct MeasurePatches {
  static constexpr Doc doc = "(E139) pressure and its force on the patches";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<StaggeredIndex<Dim>> rows,
                  Read<Patches<Dim>> patches, Uses<BodyPlacement<Dim>> placement, Optional<Read<DrySides<Dim>>> dry,
                  Read<multiplier::OpenShare> share, Read<multiplier::Pressure> p_l,
                  Optional<Read<SiteExchange>> shared, Update<measure::Columns> columns) const;
};

}  // namespace minamo
