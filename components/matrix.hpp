#pragma once
/// \file
/// The linear system of a step, as data. Rows of the stencil tables belong to active nodes; entry k of a row belongs to
/// the neighbour at offset (k % 5 - 2, k / 5 % 5 - 2, ...), so that entry 5^d - 1 - k is the way back.

#include "components/types.hpp"
#include "engine/storage/component.hpp"

#include <vector>

namespace minamo {

/// Active nodes, in the order of their place in the grid.
struct ActiveNodes {
  static constexpr std::string_view name = "matrix";
};

namespace matrix {

/// The node of a row. [1]
struct Node : Column<ActiveNodes, std::uint32_t> {
  static constexpr ComponentInfo info{"matrix.node", "I", "1", Lifetime::scratch};
};

/// The node at every place of the stencil, or none. [1]
template <int Dim>
struct Neighbour : Column<ActiveNodes, std::array<std::int32_t, stencil_size<Dim>>> {
  static constexpr std::int32_t none = -1;  ///< in place of a node
  static constexpr ComponentInfo info{"matrix.neighbour", "J", "1", Lifetime::scratch};
};

/// D_IJ = sum_p V_p S_I grad S_J, at [Dim k + d]; its transpose is the pressure gradient. [m^(d-1)]
template <int Dim>
struct Divergence : Column<ActiveNodes, std::array<double, stencil_size<Dim> * Dim>> {
  static constexpr ComponentInfo info{"matrix.divergence", "D_IJ", "m^(d-1)", Lifetime::scratch};
};

/// K_IJ, force on node I per velocity of node J, at [Dim^2 k + Dim i + j]. [kg/s]
template <int Dim>
struct Viscosity : Column<ActiveNodes, std::array<double, stencil_size<Dim> * Dim * Dim>> {
  static constexpr ComponentInfo info{"matrix.viscosity", "K_IJ", "kg/s", Lifetime::scratch};
};

/// What the stabilization adds to the mass balance: at [(Dim + 1) k + d] per acceleration of the neighbour, at
/// [(Dim + 1) k + Dim] per pressure. [m^(d-1) s, m^(d+1) s/kg]
template <int Dim>
struct Stabilization : Column<ActiveNodes, std::array<double, stencil_size<Dim>*(Dim + 1)>> {
  static constexpr ComponentInfo info{"matrix.stabilization", "", "", Lifetime::scratch};
};

/// The part of the stabilization that is known, on the right-hand side of the mass balance. [m^d/s]
struct StabilizationSource : Column<ActiveNodes, double> {
  static constexpr ComponentInfo info{"matrix.stabilization_source", "s_I", "m^d/s", Lifetime::scratch};
};

/// What of the stabilization a solver needs to know to build a good preconditioner: numbers that stand for all cells.
struct StabilizationScale {
  double pressure = 0;      ///< the largest tau_c of liquid at rest [m^3 s/kg]
  double acceleration = 0;  ///< the largest tau_c rho_c; 0 if accelerations do not enter [s]
  static constexpr ComponentInfo info{"matrix.stabilization_scale", "tau, g", "m^3 s/kg, s", Lifetime::scratch};
};

/// Right-hand side f_I of the momentum balance (E25); zero towards walls. [N]
template <int Dim>
struct Momentum : Column<ActiveNodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"matrix.momentum", "f_I", "N", Lifetime::scratch};
};

/// Right-hand side g_I of the mass balance (E26). [m^d/s]
struct Mass : Column<ActiveNodes, double> {
  static constexpr ComponentInfo info{"matrix.mass", "g_I", "m^d/s", Lifetime::scratch};
};

/// The displacement that solves (E25), (E26). [m]
template <int Dim>
struct Displacement : Column<ActiveNodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"matrix.displacement", "u_I", "m", Lifetime::scratch};
};

/// The pressure that solves (E25), (E26). [Pa]
struct Pressure : Column<ActiveNodes, double> {
  static constexpr ComponentInfo info{"matrix.pressure", "p_I", "Pa", Lifetime::scratch};
};

/// Right-hand side of the mass balance of (E37), whose momentum balance has none. [m^d/s]
struct VolumeSource : Column<ActiveNodes, double> {
  static constexpr ComponentInfo info{"matrix.volume_source", "c_v r E_I", "m^d/s", Lifetime::scratch};
};

/// The displacement that solves (E37). [m]
template <int Dim>
struct Shift : Column<ActiveNodes, Vec<Dim>> {
  static constexpr ComponentInfo info{"matrix.shift", "d_I", "m", Lifetime::scratch};
};

/// The equations of a step as one sparse matrix in compressed columns.
struct Monolithic {
  std::vector<int> outer;       ///< start of every column, and the end
  std::vector<int> inner;       ///< row of every entry, rising within a column
  std::vector<double> values;   ///< of every entry
  using rows_of = ActiveNodes;  ///< it means nothing any more when their rows change
  static constexpr ComponentInfo info{"matrix.monolithic", "", "", Lifetime::scratch};
};

}  // namespace matrix
}  // namespace minamo
