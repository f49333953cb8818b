#pragma once
/// \file
/// The pressure gradient that particles carry to the next step, for orthogonal subscales.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// (E49)  grad p_p = sum_I p_I grad S_I(y_p), kept for the next step.
template <int Dim>
struct G2PPressureGradient {
  static constexpr Doc doc = "(E49) grad p_p";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<node::Pressure> p_i, Write<particle::PressureGradient<Dim>> grad_p_p) const;
};

/// (E49)  g_I = sum_p S_Ip m_p grad p_p / m_I.
template <int Dim>
struct P2GPressureGradient {
  static constexpr Doc doc = "(E49) g_I";
  void operator()(Uses<ParticlesToNodes<Dim>> source, Read<particle::PressureGradient<Dim>> grad_p_p,
                  Write<node::PressureGradient<Dim>> g_i) const;
};

}  // namespace minamo
