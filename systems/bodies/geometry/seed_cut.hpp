#pragma once
/// \file
/// Liquid at the start, cut by bodies and by surfaces of its own.

#include "components/grid.hpp"
#include "systems/bodies/body_set.hpp"

namespace minamo {

/// Particles before they are made.
template <int Dim>
struct Seeds {
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> part;       ///< middle of its part of a cell, which walls do not move
  std::vector<std::size_t> region;  ///< that each comes from
  std::vector<double> share;        ///< of the volume of its part of a cell [1]
  /// Whether the middle of its part lies outside of a region that has its middles: what a body leaves of the part may
  /// have its own inside.
  std::vector<std::uint8_t> is_beyond;
  /// Of another rank, laid out for what its neighbours here may get or give.
  std::vector<std::uint8_t> is_guest;
};

/// What bodies have cut away of the liquid.
struct LiquidCut {
  double volume = 0;                   ///< [m^3; m^2 in 2-D]
  double of = 0;                       ///< volume of the liquid before [m^3; m^2 in 2-D]
  std::vector<std::size_t> particles;  ///< of every region, but for bodies
  static constexpr ComponentInfo info{"bodies.liquid_cut", "", "m^3", Lifetime::constant};
};

/// A region of liquid, divided into parts of cells.
template <int Dim>
struct CutRegion {
  double size = 0;         ///< edge of a part [m]
  SharedShape<Dim> shape;  ///< of the region, where it has a distance
  bool is_cut = false;     ///< whether its surface cuts parts
};

/// (E91)  A part that a body cuts is in a region if the middle of what is left of it is. A particle gets the volume
/// that bodies, and the surface of its region, leave of its part of a cell, and the place of its middle; what is less
/// than 0.3 of a part goes to the nearest particle; where there is none it is a particle if its region cuts parts and
/// has the middle of this one, else it is cut away, too. The volume of the liquid is that of what is left. Guests are
/// cut like the others, and leave.
template <int Dim>
LiquidCut cut_away(const BodySet<Dim>& set, const Grid<Dim>& grid, const std::vector<CutRegion<Dim>>& regions,
                   Seeds<Dim>& seeds);

}  // namespace minamo
