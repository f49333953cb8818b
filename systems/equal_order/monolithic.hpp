#pragma once
/// \file
/// The equations of a step as one unsymmetric sparse system in displacement and pressure.
/// Unknown (d + 1) r + i of row r is component i of the displacement, and the pressure for i = d.
///
/// (E25) Momentum, active I:  (m_I c_a + c_v K_II) u_I + c_v sum_J K_IJ u_J - sum_J D_JI p_J
///                            = m_I (b_I - a^_I) - sum_J K_IJ v'_J
/// (E26) Mass, active I:      sum_J (c_v D_IJ + c_a G_IJ) . u_J + sum_J T_IJ p_J + e_I p_I = s_I - sum_J D_IJ . v'_J
/// with G, T, s of the stabilization: (E24) PSPG has G_IJ = tau rho D_JI, T_IJ = tau L_IJ.
/// Sums with u_J or p_J run over active nodes; v'_J = v^_J + c_v u_J(E15) over all nodes.
/// (E27)                      e_I = eps dt m_I/(rho h)^2, eps = 1e-6: a lone particle gives its 3^d pressures d + 1
///                            equations, and a closed full box leaves one pressure free; e_I settles the rest.
/// Kawano, Mihara, Hashimoto; Chandra et al., CMAME 419 (2024) 116644, doi:10.1016/j.cma.2023.116644.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/equal_order/operators.hpp"

namespace minamo {

constexpr std::size_t unknowns_per_row(int dim) { return static_cast<std::size_t>(dim) + 1; }

template <int Dim>
void fill_monolithic(const Operators<Dim>& operators, matrix::Monolithic& matrix);

template <int Dim>
struct AssembleMonolithic {
  static constexpr Doc doc = "(E25) (E26) (E27) as one matrix";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates, Read<node::Row> row,
                  Read<node::Constraint> fixed, Read<node::Mass> m_i, Read<matrix::Node> node,
                  Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                  Read<matrix::Stabilization<Dim>> stabilization, Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                  Write<matrix::Monolithic> matrix) const;
};

}  // namespace minamo
