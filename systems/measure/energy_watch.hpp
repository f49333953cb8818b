#pragma once
/// \file
/// Whether a run has gained energy that nothing gave it.

#include <algorithm>

namespace minamo {

/// What a rise is judged by, in addition to the energies themselves.
struct EnergyScales {
  double exchanged = 0;   ///< with bodies, through openings and with forces, by absolute value [J]
  double unresolved = 0;  ///< of the energy of the surface, what the grid cannot tell [J]
};

/// Viscosity only takes, and so do walls that stand still: the energy less what was given to the liquid, E - W, never
/// rises. Plain data.
struct EnergyWatch {
  double lowest = 0;          ///< E - W so far [J]
  double rise = 0;            ///< largest E - W less the lowest before it [J]
  double time = 0;            ///< when that was [s]
  double kinetic_max = 0;     ///< [J]
  double stored_min = 0;      ///< potential and surface energy [J]
  double stored_max = 0;      ///< [J]
  double exchanged_max = 0;   ///< [J]
  double unresolved_max = 0;  ///< [J]

  /// \param stored  potential and surface energy [J]
  void start(double kinetic, double stored, const EnergyScales& scales = {}) {
    *this = {.lowest = kinetic + stored,
             .kinetic_max = kinetic,
             .stored_min = stored,
             .stored_max = stored,
             .exchanged_max = scales.exchanged,
             .unresolved_max = scales.unresolved};
  }
  /// \param balance  E - W [J]
  void see(double t, double balance, double kinetic, double stored, const EnergyScales& scales = {}) {
    if (balance - lowest > rise) {
      rise = balance - lowest;
      time = t;
    }
    lowest = std::min(lowest, balance);
    kinetic_max = std::max(kinetic_max, kinetic);
    stored_min = std::min(stored_min, stored);
    stored_max = std::max(stored_max, stored);
    exchanged_max = std::max(exchanged_max, scales.exchanged);
    unresolved_max = std::max(unresolved_max, scales.unresolved);
  }

  /// The rise, less what the grid cannot tell. [J]
  double gain() const { return std::max(0.0, rise - unresolved_max); }
  /// (E59)  The gain over what was there to exchange: the largest of K_max, the range of what is stored, what was
  /// exchanged and `least`.
  /// \param least  an energy that the grid can tell from zero [J]
  double share(double least) const {
    const double scale = std::max({kinetic_max, stored_max - stored_min, exchanged_max, least});
    return scale > 0 ? gain() / scale : 0;
  }
};

}  // namespace minamo
