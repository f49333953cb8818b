#pragma once
/// \file
/// Whether a run gains energy.

#include "components/measure.hpp"
#include "support/extremes.hpp"
#include "support/scene_run.hpp"

namespace minamo::scene_run {

/// The most that a value has risen above an earlier one.
template <class Value>
double largest_rise(SceneRun& run, int steps, const Value& value) {
  run.start();
  double least = value();
  double rise = 0;
  for (int n = 0; n < steps; ++n) {
    run.step();
    rise = largest_of(rise, value() - least);
    least = smallest_of(least, value());
  }
  return rise;
}

/// The most that the energy has risen above an earlier value, over that of the start (E59). [1]
inline double rise_of_energy(SceneRun& run, int steps) {
  const auto energy = [&] { return run.world().resource<measure::Energy>().total(); };
  run.start();
  const double at_start = energy();
  return largest_rise(run, steps, energy) / at_start;
}

}  // namespace minamo::scene_run
