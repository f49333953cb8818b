#pragma once
/// \file
/// Openings: parts of the sides of the box through which liquid comes in or leaves, a row each, in the order of the
/// scene; and the columns of particles that wait outside, which come in one after the other.

#include "components/staggered.hpp"

namespace minamo {

struct Openings {
  static constexpr std::string_view name = "opening";
};

/// The columns of all openings one after the other, of each x fastest along its side.
struct OpeningColumns {
  static constexpr std::string_view name = "opening_column";
};

namespace opening {

/// Mass that particles have carried in, less what they have carried out. [kg]
struct MassIn : Column<Openings, double> {
  static constexpr ComponentInfo info{"opening.mass_in", "M_o", "kg", Lifetime::state};
};

/// Energy that came in: what particles carried in, less what they carried out, and the work of the pressure. [J]
struct EnergyIn : Column<Openings, double> {
  static constexpr ComponentInfo info{"opening.energy_in", "E_o", "J", Lifetime::state};
};

/// How far the columns have moved along the side, less whole spacings. [m]
template <int Dim>
struct Drift : Column<Openings, Vec<Dim>> {
  static constexpr ComponentInfo info{"opening.drift", "T_o", "m", Lifetime::state};
};

/// Depth of the foremost particle of a column that is not yet in, -a ... 0 for the spacing a. [m]
struct Front : Column<OpeningColumns, double> {
  static constexpr ComponentInfo info{"opening.front", "phi_k", "m", Lifetime::state};
};

/// Speed of a column into the box in the last step, where the pressure drives it. [m/s]
struct Speed : Column<OpeningColumns, double> {
  static constexpr ComponentInfo info{"opening.speed", "", "m/s", Lifetime::state};
};

/// The id of the next particle that comes in. [1]
struct NextId {
  std::int64_t value = 0;
  static constexpr ComponentInfo info{"opening.next_id", "", "1", Lifetime::state};
};

/// Velocity on a side: coefficients of the splines that are not zero there, of every direction. [m/s]
template <int Dim>
struct SideVelocity {
  std::array<std::vector<double>, static_cast<std::size_t>(Dim)> of;
};

/// Velocities on the sides of all openings, in the balances and at the end of the step. [m/s]
template <int Dim>
struct Velocities {
  std::vector<SideVelocity<Dim>> in_balances;
  std::vector<SideVelocity<Dim>> at_end;
  static constexpr ComponentInfo info{"opening.velocities", "w_o", "m/s", Lifetime::scratch};
};

/// The particles that have come in in this step, from a row on, and their velocity gradients. [1/s]
template <int Dim>
struct Arrivals {
  std::size_t first_row = 0;
  std::vector<Mat<Dim>> velocity_gradient;
  static constexpr ComponentInfo info{"opening.arrivals", "", "1/s", Lifetime::scratch};
};

/// Work of the pressure in the openings in this step. [J]
struct StepWork {
  double value = 0;
  static constexpr ComponentInfo info{"opening.step_work", "", "J", Lifetime::scratch};
};

}  // namespace opening

namespace face {

/// What openings prescribe in the balances where they hold a face, zero elsewhere. [m/s]
template <int Dim>
struct Prescribed : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.prescribed", "w_f", "m/s", Lifetime::scratch};
};

/// Force of the pressure outside on faces of openings. [N]
template <int Dim>
struct OutsideForce : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.outside_force", "F_f", "N", Lifetime::scratch};
};

}  // namespace face

}  // namespace minamo
