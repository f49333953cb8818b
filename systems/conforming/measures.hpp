#pragma once
/// \file
/// How well the conforming discretization keeps the volume.

#include "components/measure.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/system.hpp"
#include "systems/conforming/splines.hpp"

namespace minamo {

/// (E31) on the staggered grid: max_l |(B v)_l|, v the velocity in the mass balance. The divergence of v at any point
/// is a mean of the (B v)_l around it.
template <int Dim>
struct MeasureFaceDivergence {
  static constexpr std::string_view doc = "(E31) largest divergence";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<staggered::Site<Dim>> site,
                  Read<staggered::Neighbour<Dim>> neighbour, Read<unknown::Staggered> of_unknown,
                  Read<face::BalanceVelocity<Dim>> v_f, Write<measure::MaxDivergence> largest) const;
};

/// (E32)  overlap = sum_l max(0, V~_l - V_l) / sum_p V_p, at y_p.
template <int Dim>
struct MeasureMultiplierOverlap {
  static constexpr std::string_view doc = "(E32) overlap";
  void operator()(Read<particle::Volume> V_p, Read<multiplier::Capacity> capacity, Read<multiplier::Volume> v_l,
                  Write<measure::Overlap> overlap) const;
};

}  // namespace minamo
