#pragma once
/// \file
/// Liquid that lies in bodies at the start is cut away.

#include "components/grid.hpp"
#include "systems/bodies/body_set.hpp"

namespace minamo {

/// Particles before they are made.
template <int Dim>
struct Seeds {
  std::vector<Vec<Dim>> position;
  std::vector<std::size_t> region;  ///< that each comes from
  std::vector<double> share;        ///< of the volume of its part of a cell [1]
};

/// What bodies have cut away of the liquid.
struct LiquidCut {
  double volume = 0;  ///< [m^3; m^2 in 2-D]
  double of = 0;      ///< volume of the liquid before [m^3; m^2 in 2-D]
  static constexpr ComponentInfo info{"bodies.liquid_cut", "", "m^3", Lifetime::constant};
};

/// (E91)  A particle gets the volume that bodies leave of its part of a cell, and the place of its middle; what is less
/// than 0.3 of a part goes to the nearest particle. The volume of the liquid is that of what is left.
/// \param size  edge of a part, by region [m]
template <int Dim>
LiquidCut cut_away(const BodySet<Dim>& set, const Grid<Dim>& grid, const std::vector<double>& size, Seeds<Dim>& seeds);

}  // namespace minamo
