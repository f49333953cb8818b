#pragma once
/// \file
/// Whether a run gains energy.

#include "components/measure.hpp"
#include "support/extremes.hpp"
#include "support/scene_run.hpp"

namespace minamo::scene_run {

/// The most that the energy has risen above an earlier value, over that of the start (E59). [1]
inline double rise_of_energy(SceneRun& run, int steps) {
  run.start();
  const auto energy = [&] { return run.world().resource<measure::Energy>().total(); };
  const double at_start = energy();
  double least = at_start;
  double rise = 0;
  for (int n = 0; n < steps; ++n) {
    run.step();
    rise = largest_of(rise, energy() - least);
    least = smallest_of(least, energy());
  }
  return rise / at_start;
}

}  // namespace minamo::scene_run
