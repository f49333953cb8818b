#pragma once
/// \file
/// The mass balance, as stencil rows of the active nodes, from the moments of the cells: divergence, and what the
/// stabilization adds. Equal-order interpolation of displacement and pressure needs a term that sees the pressure modes
/// which the divergence does not see. What differs from scheme to scheme is tau_c (material.hpp, vms.hpp). T_IJ, which
/// is made of other cell matrices than these, is filled in by AssembleLaplacian, or along with the friction by
/// AssembleViscosity.

#include "components/fluid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/step.hpp"
#include "systems/equal_order/moments.hpp"

namespace minamo {

/// (E21)  D_IJ = sum_p V_p S_I grad S_J.
/// (E24), (E50)  PSPG and VMS, sum_p tau V_p grad S_I . (rho (a_p - b_p) + grad p_p): for active J
/// G_IJ = sum_c tau_c rho_c D^c_JI, and s_I = -sum_J G_IJ . (a_J - b_J) with what is known of a_J. T. E. Tezduyar et
/// al., CMAME 95 (1992) 221, doi:10.1016/0045-7825(92)90141-6. T_IJ is zero yet.
template <int Dim>
struct AssembleDivergence {
  static constexpr Doc doc = "(E21) (E24) (E50) D_IJ, G_IJ, s_I, PSPG and VMS";
  void operator()(Read<Rates> rates, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments,
                  Read<cell::Density> rho_c, Read<cell::Tau> tau_c, Read<node::Row> row, Read<node::BodyForce<Dim>> b_i,
                  Read<node::PredictedAcceleration<Dim>> a_predicted, Read<node::Displacement<Dim>> u_i,
                  Read<matrix::Neighbour<Dim>> neighbour, Write<matrix::Divergence<Dim>> divergence,
                  Write<matrix::Stabilization<Dim>> stabilization, Write<matrix::StabilizationSource> source) const;
};

/// (E21)  D_IJ = sum_p V_p S_I grad S_J.
/// (E48)  OSS, orthogonal subscales: sum_p tau V_p grad S_I . (grad p_p - g_p), tau of (E24), g the lumped projection
/// of the pressure gradient of the step before: s_I = sum_c tau_c sum_J D^c_JI . g_J over active J, no G_IJ. Nodes less
/// than 60 % full take g_J = rho b_J: their projection is one-sided. R. Codina, CMAME 190 (2000) 1579,
/// doi:10.1016/S0045-7825(00)00254-1; the lag of one step is ours. T_IJ is zero yet.
template <int Dim>
struct AssembleDivergenceOss {
  static constexpr Doc doc = "(E21) (E48) D_IJ, s_I, OSS";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments, Read<Fluid> fluid,
                  Read<cell::Density> rho_c, Read<cell::Tau> tau_c, Read<node::Row> row, Read<node::Mass> m_i,
                  Read<node::Capacity> capacity, Read<node::BodyForce<Dim>> b_i, Read<node::PressureGradient<Dim>> g_i,
                  Write<matrix::Divergence<Dim>> divergence, Write<matrix::Stabilization<Dim>> stabilization,
                  Write<matrix::StabilizationSource> source, Update<matrix::StabilizationScale> scale) const;
};

/// (E24), (E48)  T_IJ = sum_c tau_c L^c_IJ, L_IJ = sum_p V_p grad S_I . grad S_J of (E22).
/// A viscous liquid has it from AssembleViscosity.
template <int Dim>
struct AssembleLaplacian {
  static constexpr Doc doc = "(E22) (E24) (E48) T_IJ, inviscid";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Moments<Dim>> moments,
                  Read<cell::Tau> tau_c, Read<node::Row> row, Update<matrix::Stabilization<Dim>> stabilization) const;
};

}  // namespace minamo
