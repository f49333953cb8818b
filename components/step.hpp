#pragma once
/// \file
/// What a step is made of in addition to its length (engine/run/clock.hpp).

#include "engine/storage/component.hpp"

namespace minamo {

/// How velocity and acceleration in the balances follow from the displacement: v = c_v u + v^, a = c_a u + a^.
struct Rates {
  double velocity = 0;      ///< c_v [1/s]
  double acceleration = 0;  ///< c_a [1/s^2]
  double time = 0;          ///< instant at which the momentum balance holds [s]
  static constexpr ComponentInfo info{"step.rates", "c_v, c_a", "1/s, 1/s^2", Lifetime::scratch};
};

/// Parameters of the newmark integrator.
struct NewmarkParameters {
  double beta = 0.25;  ///< [1]
  double gamma = 0.5;  ///< [1]
  static constexpr ComponentInfo info{"newmark", "beta, gamma", "1", Lifetime::constant};
};

/// Share of the volume excess that is corrected in a step. [1]
struct VolumeRate {
  double rate = 0.15;  ///< r [1]
  static constexpr ComponentInfo info{"volume.rate", "r", "1", Lifetime::constant};
};

/// Kinetic energy of the particles at the start of the step. [J]
struct EnergyBefore {
  double kinetic = 0;  ///< [J]
  static constexpr ComponentInfo info{"step.energy_before", "K^n", "J", Lifetime::scratch};
};

/// Where an iterative solver stops: residual over right-hand side. [1]
struct SolverTolerance {
  double relative = 1e-8;  ///< [1]
  static constexpr ComponentInfo info{"solver.tolerance", "", "1", Lifetime::constant};
};

/// How far a node may move in a step that is accepted, in cells. [1]
struct LargestMove {
  double cells = 10;  ///< [1]
  static constexpr ComponentInfo info{"step.largest_move", "", "1", Lifetime::constant};
};

/// Length of the step whose forces particles carry the gradient of. [s]
struct ForceStep {
  double seconds = 0;  ///< [s]
  static constexpr ComponentInfo info{"step.of_forces", "dt", "s", Lifetime::state};
};

/// Particles that a step would have carried out of the box, so far. [1]
struct Clamped {
  std::int64_t count = 0;  ///< in the whole run
  static constexpr ComponentInfo info{"clamped", "", "1", Lifetime::state};
};

}  // namespace minamo
