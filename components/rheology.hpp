#pragma once
/// \file
/// How a liquid flows whose viscosity depends on how fast it is sheared.

#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "engine/schedule/loop.hpp"

#include <algorithm>
#include <variant>
#include <vector>

namespace minamo {

/// The viscosity of every law is a function of the shear rate, sqrt(2 D:D) [1/s], that of grains of the pressure, too.
namespace rheology {

/// W. Ostwald, Kolloid-Z. 36 (1925) 99; A. de Waele (1923): consistency * rate^(index - 1), between two limits.
struct PowerLaw {
  double consistency = 0;  ///< [Pa s^index]
  double index = 1;
  double least = 0;  ///< [Pa s]
  double most = 0;   ///< [Pa s]
};
/// P. J. Carreau, Trans. Soc. Rheol. 16 (1972) 99.
struct Carreau {
  double zero = 0;      ///< viscosity at rest [Pa s]
  double infinite = 0;  ///< viscosity at high rates [Pa s]
  double time = 0;      ///< [s]
  double index = 1;
};
/// E. C. Bingham (1922), regularized after T. C. Papanastasiou, J. Rheol. 31 (1987) 385.
struct Bingham {
  double yield_stress = 0;  ///< [Pa]
  double viscosity = 0;     ///< above the yield stress [Pa s]
  double regularization = 1e5;
};
/// W. H. Herschel, R. Bulkley, Kolloid-Z. 39 (1926) 291, regularized in the same way.
struct HerschelBulkley {
  double yield_stress = 0;  ///< [Pa]
  double consistency = 0;   ///< [Pa s^index]
  double index = 1;
  double regularization = 1e5;
};

/// Dry grains. P. Jop, Y. Forterre, O. Pouliquen, Nature 441 (2006) 727, regularized in the same way.
struct MuI {
  double least = 0;     ///< friction coefficient at rest [1]
  double most = 0;      ///< at high rates [1]
  double I0 = 0;        ///< inertial number half way between [1]
  double diameter = 0;  ///< of a grain [m]
  double density = 0;   ///< of a grain [kg/m^3]
  double regularization = 1e5;
};

using Law = std::variant<PowerLaw, Carreau, Bingham, HerschelBulkley, MuI>;

inline bool depends_on_pressure(const std::vector<Law>& laws) {
  return std::any_of(laws.begin(), laws.end(), [](const Law& law) { return std::holds_alternative<MuI>(law); });
}

}  // namespace rheology

struct Rheology {
  std::vector<rheology::Law> laws;  ///< one per liquid
  int iterations = 1;               ///< most solves in a step
  static constexpr ComponentInfo info{"rheology", "mu(rate)", "Pa s", Lifetime::constant};
};

/// Repeats the solve of a step until the viscosity is that of the velocities that it gives.
struct ViscosityLoop : LoopControl {
  static constexpr ComponentInfo info{"viscosity_loop", "", "", Lifetime::scratch};
};

namespace particle {

// Not scratch: frames of the output show what the last step has found.

/// sqrt(2 D:D). [1/s]
struct ShearRate : Column<Particles, double> {
  static constexpr ComponentInfo info{"particle.shear_rate", "g_p", "1/s", Lifetime::cache};
};
/// Dynamic viscosity. [Pa s]
struct Viscosity : Column<Particles, double> {
  static constexpr ComponentInfo info{"particle.viscosity", "mu_p", "Pa s", Lifetime::cache};
};
/// Pressure of the last step, where the viscosity depends on it. [Pa]
struct LastPressure : Column<Particles, double> {
  static constexpr ComponentInfo info{"particle.last_pressure", "p_p", "Pa", Lifetime::state};
};

}  // namespace particle

namespace face {

/// v_f of the solve before. [m/s]
template <int Dim>
struct LastBalanceVelocity : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.last_balance_velocity", "v_f", "m/s", Lifetime::scratch};
};

}  // namespace face
}  // namespace minamo
