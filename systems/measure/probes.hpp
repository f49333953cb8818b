#pragma once
/// \file
/// Pressure and velocity at the probes of the scene, as columns of the history.

#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E43)  p_s = sum_I S_I(x_s) p_I.
/// (E44)  v_s = sum_I S_I(x_s) v_I / sum_I S_I(x_s), over the nodes with mass, so that the surface does not slow it
/// down. Both are zero where no node has mass: the probe is dry. The nodes have the values of the step: the pressure is
/// that at the instant of the balances, the velocity that of its end.
template <int Dim, class Velocity>
struct MeasureProbesIn {
  static constexpr Doc doc = "(E43), (E44) pressure and velocity at the probes";
  void operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows, Read<measure::Probes<Dim>> probes,
                  Read<node::Mass> m_i, Read<node::Pressure> p_i, Read<Velocity> v_i,
                  Update<measure::Columns> columns) const;
};
template <int Dim>
using MeasureProbes = MeasureProbesIn<Dim, node::NewVelocity<Dim>>;
/// Before the first step the velocity is the one that the particles start with.
template <int Dim>
using MeasureProbesAtStart = MeasureProbesIn<Dim, node::Velocity<Dim>>;

}  // namespace minamo
