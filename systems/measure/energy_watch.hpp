#pragma once
/// \file
/// Whether a run has gained energy that nothing gave it.

#include <algorithm>

namespace minamo {

/// Viscosity only takes, and so do walls that stand still: under a constant body force K + U never rises, nor does
/// K + U + W with the work W that was done on moving bodies. Plain data.
struct EnergyWatch {
  double lowest = 0;       ///< K + U + W so far [J]
  double rise = 0;         ///< largest K + U + W less the lowest before it [J]
  double time = 0;         ///< when that was [s]
  double kinetic_max = 0;  ///< [J]
  double potential_min = 0;
  double potential_max = 0;
  double work_min = 0;  ///< done on bodies since the start [J]
  double work_max = 0;

  void start(double kinetic, double potential) {
    *this = {
        .lowest = kinetic + potential, .kinetic_max = kinetic, .potential_min = potential, .potential_max = potential};
  }
  /// \param work  done on bodies since the start [J]
  void see(double t, double kinetic, double potential, double work = 0) {
    const double energy = kinetic + potential + work;
    if (energy - lowest > rise) {
      rise = energy - lowest;
      time = t;
    }
    lowest = std::min(lowest, energy);
    kinetic_max = std::max(kinetic_max, kinetic);
    potential_min = std::min(potential_min, potential);
    potential_max = std::max(potential_max, potential);
    work_min = std::min(work_min, work);
    work_max = std::max(work_max, work);
  }

  /// (E59)  The rise over what was there to exchange: the largest of K_max, U_max - U_min, W_max - W_min and `least`.
  /// \param least  an energy that the grid can tell from zero [J]
  double share(double least) const {
    const double scale = std::max({kinetic_max, potential_max - potential_min, work_max - work_min, least});
    return scale > 0 ? rise / scale : 0;
  }
};

}  // namespace minamo
