#pragma once
/// \file
/// What a stabilization contributes to the mass balance: equal-order interpolation of displacement and pressure needs a
/// term that sees the pressure modes which the divergence does not see. Each scheme fills matrix::Stabilization and
/// matrix::StabilizationSource; the assembly knows no scheme.

#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/clock.hpp"
#include "engine/system.hpp"

namespace minamo {

/// (E24)  PSPG: sum_p tau V_p grad S_I . (rho (a_p - b_p) + grad p_p), tau = [(2 rho/dt)^2 + (4 mu/h^2)^2]^(-1/2).
/// T. E. Tezduyar et al., CMAME 95 (1992) 221, doi:10.1016/0045-7825(92)90141-6. There is no term with |v| in tau,
/// which would not be Galilean invariant.
template <int Dim>
struct StabilizePspg {
  static constexpr std::string_view doc = "(E24) PSPG";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<node::Row> row,
                  Read<node::BodyForce<Dim>> b_i, Read<node::KnownAcceleration<Dim>> a_known,
                  Read<matrix::Neighbour<Dim>> neighbour, Read<matrix::Divergence<Dim>> divergence,
                  Read<matrix::Laplacian<Dim>> laplacian, Write<matrix::Stabilization<Dim>> stabilization,
                  Write<matrix::StabilizationSource> source, Write<matrix::StabilizationScale> scale) const;
};

/// (E48)  OSS, orthogonal subscales: sum_p tau V_p grad S_I . (grad p_p - g_p), tau of (E24), g the lumped projection
/// of the pressure gradient of the step before. Nodes less than 60 % full take g_J = rho b_J: their projection is
/// one-sided. R. Codina, CMAME 190 (2000) 1579, doi:10.1016/S0045-7825(00)00254-1; the lag of one step is ours.
template <int Dim>
struct StabilizeOss {
  static constexpr std::string_view doc = "(E48) orthogonal subscales";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<node::Capacity> capacity, Read<Fluid> fluid,
                  Read<node::Row> row, Read<node::Mass> m_i, Read<node::BodyForce<Dim>> b_i,
                  Read<node::PressureGradient<Dim>> g_i, Read<matrix::Neighbour<Dim>> neighbour,
                  Read<matrix::Divergence<Dim>> divergence, Read<matrix::Laplacian<Dim>> laplacian,
                  Write<matrix::Stabilization<Dim>> stabilization, Write<matrix::StabilizationSource> source,
                  Write<matrix::StabilizationScale> scale) const;
};

/// (E49)  grad p_p = sum_I p_I grad S_I(y_p), kept for the next step.
template <int Dim>
struct G2PPressureGradient {
  static constexpr std::string_view doc = "(E49) grad p_p";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::Configuration<Dim>> y_p,
                  Read<node::Pressure> p_i, Write<particle::PressureGradient<Dim>> grad_p_p) const;
};

/// (E49)  g_I = sum_p S_Ip m_p grad p_p / m_I.
template <int Dim>
struct P2GPressureGradient {
  static constexpr std::string_view doc = "(E49) g_I";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::Configuration<Dim>> y_p,
                  Read<particle::Mass> m_p, Read<particle::PressureGradient<Dim>> grad_p_p, Read<node::Mass> m_i,
                  Write<node::PressureGradient<Dim>> g_i) const;
};

}  // namespace minamo
