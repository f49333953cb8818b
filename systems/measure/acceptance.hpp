#pragma once
/// \file
/// Whether a step can be trusted. That the solve has converged is the solver's own business; here is what came of it.

#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/linear_solver.hpp"
#include "engine/system.hpp"
#include "systems/output/history.hpp"

namespace minamo {

/// (E58)  Accepts a step if |r| <= 1e-6 |b| (or the solver's tolerance, where that is more), all u_I are finite and
/// those of nodes above the mass threshold (E7) at most LargestMove, energy and momenta are finite, and the overlap
/// (E32) has not grown by more than a fifth of the liquid.
template <int Dim>
struct AcceptStep {
  static constexpr std::string_view doc = "(E58) reject the step if it cannot be trusted";
  /// \throws StepRejected naming the bound and the worst node or particle, where it is and its value.
  void operator()(Read<Grid<Dim>> grid, Read<LargestMove> largest, Read<SolverTolerance> tolerance,
                  Read<SolveReport> solve, Read<node::Site<Dim>> site, Read<node::Mass> m_i,
                  Read<node::Displacement<Dim>> u_i, Read<particle::Id> id, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Read<measure::Energy> energy,
                  Read<measure::Momentum<Dim>> momentum, Read<measure::Overlap> overlap, Read<RunTotals> so_far) const;
};

}  // namespace minamo
