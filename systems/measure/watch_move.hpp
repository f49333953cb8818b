#pragma once
/// \file
/// Whether a fixed step is too long for what moves in it.

#include "components/grid.hpp"
#include "components/measure.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/warnings.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// A step in which the fastest particle crosses more cells loses accuracy: 7 of them made a pipe flow 17 % wrong. [1]
inline constexpr double longest_sound_move = 2;

/// Warns once if max |v_p| dt > 2 h, and names the step of CFL number 1.
template <int Dim>
struct WatchMove {
  static constexpr Doc doc = "warn if a fixed step moves particles by more than two cells";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<measure::MaxSpeed> speed,
                  Update<Warnings> warnings) const;
};

}  // namespace minamo
