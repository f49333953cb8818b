#pragma once
/// \file
/// Delta-correction: one step of steepest descent on the excess of particle volume around the nodes. It pushes
/// particles apart where they clump, and does nothing else. In the manner of particle shifting in stabilized MPM, B.
/// Chandra et al., CMAME 419 (2024) 116644, doi:10.1016/j.cma.2023.116644; the length of the step by a line search is
/// ours.

#include "components/advected_node.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E52)  x_p -= lambda g_p, at most 0.1 h; g_p = sum_I e_I grad S_I(x_p), e_I = max(0, V~_I - V_I); with the response
/// r_I = sum_p V_p grad S_I . g_p, lambda = sum e_I r_I / sum r_I^2 over nodes with e_I > 0.
template <int Dim>
struct ShiftByDelta {
  static constexpr Doc doc = "(E52) x_p, delta-correction";
  void operator()(Read<Grid<Dim>> grid, Read<particle::Volume> V_p, Read<AdvectedNodeIndex<Dim>> rows,
                  Read<advected_node::Capacity> capacity, Read<advected_node::Volume> v_i,
                  Write<advected_node::VolumeExcess> e_i, Write<advected_node::VolumeResponse> r_i,
                  Update<particle::Position<Dim>> x_p) const;
};

}  // namespace minamo
