#pragma once
/// \file
/// Warns of volume that is lost, while the run goes on.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/run/warnings.hpp"
#include "engine/schedule/system.hpp"
#include "systems/measure/acceptance.hpp"
#include "systems/measure/lowest_place.hpp"
#include "systems/openings/opening_set.hpp"

#include <string>

namespace minamo {

/// What a scene may change to keep its volume, a phrase each.
struct VolumeAdvice {
  std::vector<std::string> phrases;
  static constexpr ComponentInfo info{"measure.volume_advice", "", "", Lifetime::constant};
};

/// (E127)  Warns where the largest overlap (E32) so far is more than 0.05, and again, with what to change, where it is
/// more than 0.2; where the liquid lies lower than 0.98 of its volume can; where particles lie outside of the grid, but
/// for those that have left through an opening.
template <int Dim>
struct WatchVolume {
  static constexpr Doc doc = "(E127) warnings of volume that is lost";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<BodyForce> b, Optional<Read<Splines<Dim>>> splines,
                  Optional<Read<StaticCut<Dim>>> at_rest, Optional<Read<OpeningSet<Dim>>> openings,
                  Optional<Read<Ranks>> ranks, Read<particle::Volume> V_p, Read<particle::Position<Dim>> x_p,
                  Read<StepTotals> so_far, Read<VolumeAdvice> advice, Update<LowestPlace> lowest,
                  Update<Warnings> warnings) const;
};

}  // namespace minamo
