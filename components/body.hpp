#pragma once
/// \file
/// Bodies: solids in the liquid, a row each, in the order of the scene, and what they leave open of the staggered grid.

#include "components/rigid.hpp"
#include "components/staggered.hpp"

namespace minamo {

struct Bodies {
  static constexpr std::string_view name = "body";
};

namespace body {

/// Place c_b of the point that the body turns about. [m]
template <int Dim>
struct Position : Column<Bodies, Vec<Dim>> {
  static constexpr ComponentInfo info{"body.position", "c_b", "m", Lifetime::state};
};

/// Rotation R_b since the start. [1]
template <int Dim>
struct Rotation : Column<Bodies, Mat<Dim>> {
  static constexpr ComponentInfo info{"body.rotation", "R_b", "1", Lifetime::state};
};

/// Velocity V_b of that point. [m/s]
template <int Dim>
struct Velocity : Column<Bodies, Vec<Dim>> {
  static constexpr ComponentInfo info{"body.velocity", "V_b", "m/s", Lifetime::state};
};

/// Angular velocity. [1/s]
template <int Dim>
struct Spin : Column<Bodies, Vec<rotations<Dim>>> {
  static constexpr ComponentInfo info{"body.spin", "omega_b", "1/s", Lifetime::state};
};

/// Turned since the start, the integral of the angular velocity. [1]
template <int Dim>
struct Angle : Column<Bodies, Vec<rotations<Dim>>> {
  static constexpr ComponentInfo info{"body.angle", "alpha_b", "1", Lifetime::state};
};

/// Work that the liquid has done on the body. [J]
struct Work : Column<Bodies, double> {
  static constexpr ComponentInfo info{"body.work", "W_b", "J", Lifetime::state};
};
/// The same at the start of the step. [J]
struct OldWork : Column<Bodies, double> {
  static constexpr ComponentInfo info{"body.old_work", "W_b^n", "J", Lifetime::scratch};
};

/// Place in the middle of the step, for which the grid is cut. [m]
template <int Dim>
struct MiddlePosition : Column<Bodies, Vec<Dim>> {
  static constexpr ComponentInfo info{"body.middle_position", "c_b", "m", Lifetime::scratch};
};

/// Rotation in the middle of the step. [1]
template <int Dim>
struct MiddleRotation : Column<Bodies, Mat<Dim>> {
  static constexpr ComponentInfo info{"body.middle_rotation", "R_b", "1", Lifetime::scratch};
};

/// Displacement over the length of the step; of free bodies V_b^n until they are coupled to the liquid. [m/s]
template <int Dim>
struct MeanVelocity : Column<Bodies, Vec<Dim>> {
  static constexpr ComponentInfo info{"body.mean_velocity", "V_b", "m/s", Lifetime::scratch};
};

/// Turn over the length of the step; of free bodies omega_b^n until they are coupled to the liquid. [1/s]
template <int Dim>
struct MeanSpin : Column<Bodies, Vec<rotations<Dim>>> {
  static constexpr ComponentInfo info{"body.mean_spin", "omega_b", "1/s", Lifetime::scratch};
};

/// Velocity at the end of the step, of free bodies by their balance. [m/s]
template <int Dim>
struct EndVelocity : Column<Bodies, Vec<Dim>> {
  static constexpr ComponentInfo info{"body.end_velocity", "V_b^{n+1}", "m/s", Lifetime::scratch};
};

/// Angular velocity at the end of the step, of free bodies by their balance. [1/s]
template <int Dim>
struct EndSpin : Column<Bodies, Vec<rotations<Dim>>> {
  static constexpr ComponentInfo info{"body.end_spin", "omega_b^{n+1}", "1/s", Lifetime::scratch};
};

/// Force on the body of the pressure at the instant of the balances, of the impulse of damping, and of the particles
/// that it stops. [N; N/m in 2-D]
template <int Dim>
struct Force : Column<Bodies, Vec<Dim>> {
  static constexpr ComponentInfo info{"body.force", "F_b", "N", Lifetime::scratch};
};

/// Torque of these about the body's position. [N m; N in 2-D]
template <int Dim>
struct Torque : Column<Bodies, Vec<rotations<Dim>>> {
  static constexpr ComponentInfo info{"body.torque", "T_b", "N m", Lifetime::scratch};
};

/// Impulse that the body got from particles that it stopped, and its moment about the body's position; of the end of
/// the last step. [N s, N m s]
template <int Dim>
struct StopImpulse : Column<Bodies, RigidVector<Dim>> {
  static constexpr ComponentInfo info{"body.stop_impulse", "J_b", "N s", Lifetime::state};
};

/// The same from particles that it stopped in the first half of the step; not of free bodies. [N s, N m s]
template <int Dim>
struct PlateImpulse : Column<Bodies, RigidVector<Dim>> {
  static constexpr ComponentInfo info{"body.plate_impulse", "J_b", "N s", Lifetime::scratch};
};

}  // namespace body

namespace face {

/// Share a_f of a face that no body closes; of the plane between two multipliers. [1]
template <int Dim>
struct Open : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.open", "a_f", "1", Lifetime::scratch};
};

/// Share of the volume around a face that no body takes: the mean of the multipliers below and above. [1]
template <int Dim>
struct OpenVolume : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.open_volume", "", "1", Lifetime::scratch};
};

/// Mass that the particles around a face would have if bodies cut nothing away. [kg]
template <int Dim>
struct UncutMass : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.uncut_mass", "m_f/a_f", "kg", Lifetime::scratch};
};

/// What moving bodies let through a face, the share that they close times their velocity. [m/s]
template <int Dim>
struct WallFlux : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.wall_flux", "sum_b c_fb w_b", "m/s", Lifetime::scratch};
};

/// The same with their velocities at the start of the step. [m/s]
template <int Dim>
struct OldWallFlux : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.old_wall_flux", "sum_b c_fb w_b^n", "m/s", Lifetime::scratch};
};

/// Who closes a face: per direction the nearest body at rest and the nearest moving one, and the share of each.
template <int Dim>
struct Closed : Column<Staggered, std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"face.closed", "c_fb", "1", Lifetime::scratch};
};
template <int Dim>
struct Closer : Column<Staggered, std::array<std::array<std::int16_t, 2>, static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"face.closer", "b", "1", Lifetime::scratch};
};

/// Mass of the liquid between a body and a face that the face does not see, to its direction alone; less than zero
/// where the body reaches into what the face stands for. [kg]
template <int Dim>
struct AttachedMass : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.attached_mass", "m_fb", "kg", Lifetime::scratch};
};
/// The body that it moves with, by direction. [1]
template <int Dim>
struct AttachedTo : Column<Staggered, std::array<std::int16_t, static_cast<std::size_t>(Dim)>> {
  static constexpr ComponentInfo info{"face.attached_to", "b", "1", Lifetime::scratch};
};

}  // namespace face

namespace multiplier {

/// Share of the volume around a multiplier that no body takes. [1]
struct OpenShare : Column<Staggered, double> {
  // State, because output recovers the pressure with it after the step.
  static constexpr ComponentInfo info{"multiplier.open_share", "", "1", Lifetime::state};
};

}  // namespace multiplier

}  // namespace minamo
