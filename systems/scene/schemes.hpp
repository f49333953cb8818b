#pragma once
/// \file
/// The choices of a scene in addition to the transfer scheme. Every type is registered by name,
/// `registry.add(Stabilization{{...}})`, by the built-in parts and by programs that link minamo alike.

#include "systems/scene/part.hpp"

#include <cstdint>

namespace minamo {

/// How velocity and acceleration follow from the displacement. Sets IntegratorNeeds.
struct Integrator : Scheme {};
/// Where the integrals of the balances are taken.
struct Quadrature : Scheme {};
/// What makes pressures of equal order with the displacement stable.
struct Stabilization : Scheme {};
/// What keeps the particles apart.
struct VolumeCorrection : Scheme {};

/// What a side of the box does to the liquid.
struct WallCondition {
  std::string name;  ///< as in the scene
  std::string doc;   ///< one line
  /// The directions that a wall of the axis holds, bit d for direction d.
  std::function<std::uint8_t(int dimension, int axis)> held;
  bool separates = false;  ///< lets the liquid leave, for the conforming discretization
  bool is_length = false;  ///< given as {name: slip length}, for the conforming discretization, and not as a name alone
};

/// What the walls of a scene tell other parts.
struct WallFriction {
  double largest_per_length = 0;  ///< 1/b of the shortest slip length b [1/m]
  bool any_side_slips = false;    ///< whether the liquid slips along a side of the box
};

/// A linear solver is three lists of systems.
struct LinearSolver {
  std::string name;                       ///< as in the scene
  std::string doc;                        ///< one line
  std::vector<std::string> prepare;       ///< what they write, solve and solve_volume read
  std::vector<std::string> solve;         ///< matrix.displacement, matrix.pressure from matrix.momentum, matrix.mass
  std::vector<std::string> solve_volume;  ///< matrix.shift from matrix.volume_source
  /// What solves the equations of the conforming discretization, what makes velocities of the multipliers, and what
  /// solves those with friction in the balances.
  std::vector<std::string> solve_on_faces = {"prepare_multipliers", "solve_multipliers"};
  std::vector<std::string> project_on_faces = {"project_faces"};          ///< velocities of multipliers
  std::vector<std::string> solve_friction_on_faces = {"solve_friction"};  ///< with friction
  std::function<Contribution(Input&, Scene&)> read = {};                  ///< its options; may be empty
  /// Largest memory that matrices and factors take per node with a row. [byte]
  std::function<double(const Scene&, double nodes)> bytes_per_node;
  std::string leaner = {};  ///< name of a solver that needs less memory
};

/// Walls that the liquid may leave: the balances are solved again until contact fits, by another part than the solver.
struct RepeatsBalances {
  bool at_sides = false;   ///< of the box
  bool at_bodies = false;  ///< solids in it
};

/// What an integrator asks of the start and of the transfer.
struct IntegratorNeeds {
  /// The system that configures standing steps for what particles carry of the step before.
  std::string also_configured;
  /// Whether velocity gradients move on with their particles, (E62): not where the weights lag behind by a step.
  bool gradients_move = true;
};

}  // namespace minamo
