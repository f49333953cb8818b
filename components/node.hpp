#pragma once
/// \file
/// What grid nodes carry. One row per node of an occupied dual cell, in the order of their sites, x fastest; numbered
/// anew whenever particles are sorted (sites.hpp).
/// A node is empty (no mass), ballistic (below the mass threshold: no pressure, it moves freely), or active (a row of
/// the matrix).

#include "components/types.hpp"
#include "engine/storage/component.hpp"

namespace minamo {

/// The table of nodes: a row per node of an occupied dual cell.
struct Nodes {
  static constexpr std::string_view name = "node";
};

namespace node {

/// Where the node is in the grid: (i, j, k). [1]
template <int Dim>
struct Site : Column<Nodes, Index<Dim>> {
  // State, because rows of other state mean nothing without it.
  static constexpr ComponentInfo info{"node.site", "", "1", Lifetime::state};
};

/// Directions in which walls prescribe the velocity: bit d for axis d of the node's frame. [1]
struct Constraint : Column<Nodes, std::uint8_t> {
  static constexpr ComponentInfo info{"node.constraint", "", "1", Lifetime::scratch};
};

/// The node's frame, a rotation whose rows are its axes. A scene without oblique walls has no such column: frames are
/// that of the grid. [1]
template <int Dim>
struct ConstraintFrame : Column<Nodes, Mat<Dim>> {
  static constexpr ComponentInfo info{"node.constraint_frame", "R_I", "1", Lifetime::scratch};
};

/// Velocity of the wall, prescribed in the held directions. A scene whose walls are at rest has no such column. [m/s]
template <int Dim>
struct ConstraintVelocity : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.constraint_velocity", "w_I", "m/s", Lifetime::scratch};
};

/// Row in the matrix tables, -1 for a node that is not active. [1]
struct Row : Column<Nodes, std::int32_t> {
  static constexpr ComponentInfo info{"node.row", "", "1", Lifetime::scratch};
};

/// Mass m_I. [kg]
struct Mass : Column<Nodes, double> {
  static constexpr ComponentInfo info{"node.mass", "m_I", "kg", Lifetime::scratch};
};

/// V_I of (E39): volume of the part of the domain that the node stands for, the integral of S_I. [m^3; m^2 in 2-D]
struct Capacity : Column<Nodes, double> {
  static constexpr ComponentInfo info{"node.capacity", "V_I", "m^d", Lifetime::scratch};
};

/// Fill fraction phi_I of (E67): what the particles fill of the capacity. [1]
struct FillFraction : Column<Nodes, double> {
  static constexpr ComponentInfo info{"node.fill_fraction", "phi_I", "1", Lifetime::scratch};
};

/// theta_I of (E67): 1 where all nodes around are filled, so that integrals need no particles. [1]
struct FilledIndicator : Column<Nodes, double> {
  static constexpr ComponentInfo info{"node.filled_indicator", "theta_I", "1", Lifetime::scratch};
};

/// Velocity v_I^n at the start of the step. [m/s]
template <int Dim>
struct Velocity : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.velocity", "v_I^n", "m/s", Lifetime::scratch};
};

/// Acceleration a_I^n at the start of the step. [m/s^2]
template <int Dim>
struct Acceleration : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.acceleration", "a_I^n", "m/s^2", Lifetime::scratch};
};

/// Body force per unit mass b_I. [m/s^2]
template <int Dim>
struct BodyForce : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.body_force", "b_I", "m/s^2", Lifetime::scratch};
};

/// Part of the velocity in the balances that does not depend on the unknown displacement. [m/s]
template <int Dim>
struct PredictedVelocity : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.predicted_velocity", "v^_I", "m/s", Lifetime::scratch};
};

/// Part of the acceleration in the balances that does not depend on the unknown displacement. [m/s^2]
template <int Dim>
struct PredictedAcceleration : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.predicted_acceleration", "a^_I", "m/s^2", Lifetime::scratch};
};

/// Lumped projection g_I of the pressure gradient of the step before. [Pa/m]
template <int Dim>
struct PressureGradient : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.pressure_gradient", "g_I", "Pa/m", Lifetime::scratch};
};

/// Acceleration c_I that lumping the mass leaves out; zero at nodes that are not active and towards walls. [m/s^2]
template <int Dim>
struct InertiaCorrection : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.inertia_correction", "c_I", "m/s^2", Lifetime::scratch};
};

/// Displacement u_I over the step. [m]
template <int Dim>
struct Displacement : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.displacement", "u_I", "m", Lifetime::scratch};
};

/// Pressure p_I; zero at nodes that are not active. [Pa]
struct Pressure : Column<Nodes, double> {
  // State, because output samples it after the step.
  static constexpr ComponentInfo info{"node.pressure", "p_I", "Pa", Lifetime::state};
};

/// Velocity v*_I that FMPM hands to the particles, and XPIC in addition to the change of the step. [m/s]
template <int Dim>
struct FilteredVelocity : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.filtered_velocity", "v*_I", "m/s", Lifetime::scratch};
};

/// What the filter of XPIC and FMPM has not yet passed. [m/s]
template <int Dim>
struct Residue : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.residue", "r_I", "m/s", Lifetime::scratch};
};

/// The residue after a trip to the particles and back. [m/s]
template <int Dim>
struct Smoothed : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.smoothed", "S^+ S r_I", "m/s", Lifetime::scratch};
};

/// Displacement d_I that corrects the volume. [m]
template <int Dim>
struct Shift : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.shift", "d_I", "m", Lifetime::scratch};
};

/// Velocity v_I^{n+1} at the end of the step. [m/s]
template <int Dim>
struct NewVelocity : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.new_velocity", "v_I^{n+1}", "m/s", Lifetime::scratch};
};

/// Acceleration a_I^{n+1} at the end of the step. [m/s^2]
template <int Dim>
struct NewAcceleration : Column<Nodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"node.new_acceleration", "a_I^{n+1}", "m/s^2", Lifetime::scratch};
};

}  // namespace node
}  // namespace minamo
