#pragma once
/// \file
/// Volume projection: div v = 0 on the grid does not keep particles from clumping, so after the step the excess of
/// particle volume around the nodes is pushed apart by a displacement that the matrix of the step gives at the cost of
/// a back substitution. Positions change, velocities stay. After T. Kugelstadt et al., Implicit density projection for
/// volume conserving liquids, IEEE TVCG 27 (2021) 2385, doi:10.1109/TVCG.2019.2947437; there a second Poisson solve,
/// here the factors of the step.

#include "components/advected_node.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/sites.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E35)  V~_I = sum_p S_I(x_p^{n+1}) V_p.
template <int Dim>
struct GatherNodeVolume {
  static constexpr Doc doc = "(E35) V~_I at the end of the step";
  void operator()(Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p, Read<particle::Volume> V_p,
                  Resize<AdvectedNodes> nodes, Write<AdvectedNodeIndex<Dim>> rows,
                  Write<advected_node::Site<Dim>> sites, Write<advected_node::Volume> v_i) const;
};

/// (E36)  E_I = V~_I - V_I where positive, or where the node is deep inside the liquid.
template <int Dim>
struct FindVolumeExcess {
  static constexpr Doc doc = "(E36) E_I";
  void operator()(Read<Grid<Dim>> grid, Read<AdvectedNodeIndex<Dim>> rows, Read<advected_node::Site<Dim>> sites,
                  Read<advected_node::Capacity> capacity, Read<advected_node::Volume> v_i,
                  Write<advected_node::VolumeExcess> e_i) const;
};

/// (E37)  The system of the step with right-hand side (0; c_v r E_I) instead has a displacement d_I with D d = r E. The
/// solver finds it.
template <int Dim>
struct FillVolumeSource {
  static constexpr Doc doc = "(E37) c_v r E_I";
  void operator()(Read<Rates> rates, Read<VolumeRate> rate, Read<node::Site<Dim>> sites, Read<matrix::Node> node,
                  Read<AdvectedNodeIndex<Dim>> end_rows, Read<advected_node::VolumeExcess> e_i,
                  Write<matrix::VolumeSource> source) const;
};

template <int Dim>
struct UnpackShift {
  static constexpr Doc doc = "d_I from the solution";
  void operator()(Read<matrix::Shift<Dim>> solution, Read<node::Row> row, Write<node::Shift<Dim>> d_i) const;
};

/// (E38)  x_p += sum_I S_I(x_p) d_I, at most 0.1 h.
template <int Dim>
struct ShiftParticles {
  static constexpr Doc doc = "(E38) x_p, shifted";
  void operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows, Read<node::Shift<Dim>> d_i,
                  Update<particle::Position<Dim>> x_p) const;
};

}  // namespace minamo
