#pragma once
/// \file
/// What keeps the midpoint rule from turning a divergence over and over.
///
/// The midpoint rule makes v_mid free of divergence, and v^{n+1} = 2 v_mid - v^n. So what divergence v^n has, from the
/// transfers or an impact, v^{n+1} has with the other sign: an oscillation from step to step that nothing damps, and
/// that the free surface can feed. FLIP's next to no dissipation let it grow by 5 % a step in a layer at rest.
/// (E63)  div v_mid = kappa e, e = tr g + (dt/2) tr(g g), g = grad v^n over the middle of the step, kappa = 0.1
/// leaves -(1 - 2 kappa) of it. e is zero for a velocity that has no divergence where the particles were at the start
/// of the step: over x = y - (dt/2) v its gradient is g + (dt/2) g g + O(dt^2), so the rule stays second order. The
/// second term fades as (E62) does, in spray and where the strain of half a step is not resolved. Ours.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E63), into the right-hand side of (E26).
template <int Dim>
struct DampDivergence {
  static constexpr Doc doc = "(E63) part of the divergence at the start, let out at the middle";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<node::Site<Dim>> site,
                  Read<node::Mass> m_i, Read<node::Capacity> capacity, Read<node::Velocity<Dim>> v_i,
                  Read<matrix::Node> node, Read<matrix::Neighbour<Dim>> neighbour,
                  Read<matrix::Divergence<Dim>> divergence, Update<matrix::Mass> g) const;
};

}  // namespace minamo
