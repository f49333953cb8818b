#pragma once
/// \file
/// What particles carry. Rows are kept sorted by dual cell (cells.hpp); `Id` tells who is who.

#include "components/types.hpp"
#include "engine/storage/component.hpp"

namespace minamo {

/// The table of particles: a row per particle.
struct Particles {
  static constexpr std::string_view name = "particle";
};

namespace particle {

/// Number given at the start, 0, 1, 2, ... in order of creation. [1]
struct Id : Column<Particles, std::int64_t> {
  static constexpr ComponentInfo info{"particle.id", "p", "1", Lifetime::state};
};

/// Mass m_p, constant. In 2-D per metre of depth. [kg]
struct Mass : Column<Particles, double> {
  static constexpr ComponentInfo info{"particle.mass", "m_p", "kg", Lifetime::state};
};

/// Volume V_p, constant: the liquid is incompressible. [m^3; m^2 in 2-D]
struct Volume : Column<Particles, double> {
  static constexpr ComponentInfo info{"particle.volume", "V_p", "m^d", Lifetime::state};
};

/// Position x_p. [m]
template <int Dim>
struct Position : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.position", "x_p", "m", Lifetime::state};
};

/// Quadrature position y_p, at which the step takes its weights: x_p^n, or the middle of the step. [m]
template <int Dim>
struct QuadraturePosition : Column<Particles, Vec<Dim>> {
  // State, because the sort of the particles carries it along and output samples nodal fields there.
  static constexpr ComponentInfo info{"particle.quadrature_position", "y_p", "m", Lifetime::state};
};

/// Velocity v_p. [m/s]
template <int Dim>
struct Velocity : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.velocity", "v_p", "m/s", Lifetime::state};
};

/// Velocity gradient, row i the gradient of component i. [1/s]
template <int Dim>
struct VelocityGradient : Column<Particles, Mat<Dim>> {
  static constexpr ComponentInfo info{"particle.velocity_gradient", "grad v_p", "1/s", Lifetime::state};
};

/// Second derivatives of the velocity, in the order xx xy yy, in 3-D xx xy xz yy yz zz: as much of them as the
/// transfer keeps. [1/(m s)]
template <int Dim>
struct VelocityCurvature : Column<Particles, Eigen::Matrix<double, Dim, Dim*(Dim + 1) / 2>> {
  static constexpr ComponentInfo info{"particle.velocity_curvature", "H_p", "1/(m s)", Lifetime::state};
};

/// Acceleration a_p. [m/s^2]
template <int Dim>
struct Acceleration : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.acceleration", "a_p", "m/s^2", Lifetime::state};
};

/// Acceleration gradient, row i the gradient of component i. [1/s^2]
template <int Dim>
struct AccelerationGradient : Column<Particles, Mat<Dim>> {
  static constexpr ComponentInfo info{"particle.acceleration_gradient", "grad a_p", "1/s^2", Lifetime::state};
};

/// Gradient of the acceleration that force over lumped mass gave the nodes in the last step, row i of component i.
/// [1/s^2]
template <int Dim>
struct ForceGradient : Column<Particles, Mat<Dim>> {
  static constexpr ComponentInfo info{"particle.force_gradient", "grad f_p", "1/s^2", Lifetime::state};
};

/// Pressure p_p, sampled for output. [Pa]
struct Pressure : Column<Particles, double> {
  static constexpr ComponentInfo info{"particle.pressure", "p_p", "Pa", Lifetime::scratch};
};

/// Pressure gradient of the last solve. [Pa/m]
template <int Dim>
struct PressureGradient : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.pressure_gradient", "grad p_p", "Pa/m", Lifetime::state};
};

/// Body force per unit mass b_p, where it varies in space. [m/s^2]
template <int Dim>
struct BodyForce : Column<Particles, Vec<Dim>> {
  static constexpr ComponentInfo info{"particle.body_force", "b_p", "m/s^2", Lifetime::scratch};
};

}  // namespace particle
}  // namespace minamo
