#pragma once
/// \file
/// Columns of the history for openings.

#include "components/measure.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/openings/opening_set.hpp"

namespace minamo {

/// NAME_mass_in [kg], NAME_energy_in [J], NAME_rate into the box in the balances [m^3/s; m^2/s in 2-D], and how many
/// particles there are.
template <int Dim>
struct MeasureOpenings {
  static constexpr Doc doc = "what came in through openings";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<OpeningSet<Dim>> set,
                  Read<opening::Velocities<Dim>> velocities, Read<opening::MassIn> mass_in,
                  Read<opening::EnergyIn> energy_in, Read<particle::Id> id, Optional<Read<Ranks>> ranks,
                  Update<measure::Columns> columns) const;
};

/// The same before the first step, when there are no rates.
template <int Dim>
struct MeasureOpeningsAtStart {
  static constexpr Doc doc = "what came in through openings, at the start";
  void operator()(Read<OpeningSet<Dim>> set, Read<opening::MassIn> mass_in, Read<opening::EnergyIn> energy_in,
                  Read<particle::Id> id, Optional<Read<Ranks>> ranks, Update<measure::Columns> columns) const;
};

}  // namespace minamo
