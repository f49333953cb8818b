#pragma once
/// \file
/// Whether a step can be trusted. That the solve has converged is the solver's own business; here is what came of it.

#include "components/grid.hpp"
#include "components/measure.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/run/step_control.hpp"
#include "engine/schedule/system.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// Of all accepted steps.
struct StepTotals {
  double overlap = 0;  ///< after the last [1]
  double overlap_max = 0;
  std::int64_t active_nodes_max = 0;
  std::int64_t unknowns_max = 0;
  static constexpr ComponentInfo info{"step.totals", "", "", Lifetime::state};
};

/// (E58)  Accepts a step if |r| <= 1e-6 |b| (or the solver's tolerance, where that is more), all u_I are finite and
/// those of nodes above the mass threshold (E7) at most LargestMove, what particles carry is finite, and the overlap
/// (E32) has not grown by more than a fifth of the liquid, nor, where it is more than a fifth and more than ever, by
/// more than a fiftieth. An eighth of a step is not held to the latter: what that does not mend no shorter one does.
template <int Dim>
struct AcceptStep {
  static constexpr Doc doc = "(E58) reject the step if it cannot be trusted";
  /// \throws StepRejected naming the bound and the worst node or particle, where it is and its value.
  void operator()(Read<Grid<Dim>> grid, Read<LargestMove> largest, Read<SolverTolerance> tolerance,
                  Read<SolveReport> solve, Read<node::Site<Dim>> site, Read<node::Mass> m_i,
                  Read<node::Displacement<Dim>> u_i, Read<particle::Id> id, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                  Read<measure::Overlap> overlap, Read<StepTotals> so_far, Read<StepControl> control) const;
};

/// (E58) of the conforming discretization, whose overlap is that at y_p: what the second half of a step squeezes is
/// seen in the next one. If particles move by less than a quarter of a cell there, no shorter step would help.
template <int Dim>
struct AcceptStepOnFaces {
  static constexpr Doc doc = "(E58) reject the step if it cannot be trusted";
  /// \throws StepRejected naming the bound and the worst face or particle, where it is and its value.
  void operator()(Read<Grid<Dim>> grid, Read<LargestMove> largest, Read<SolverTolerance> tolerance,
                  Read<SolveReport> solve, Read<staggered::Site<Dim>> site, Read<face::Mass<Dim>> m_f,
                  Read<face::Displacement<Dim>> u_f, Read<particle::Id> id, Read<particle::Position<Dim>> x_p,
                  Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Velocity<Dim>> v_p,
                  Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p, Optional<Read<SiteExchange>> shared,
                  Read<measure::Overlap> overlap, Read<StepTotals> so_far, Read<StepControl> control) const;
};

/// The start counts.
template <int Dim>
struct NoteStep {
  static constexpr Doc doc = "what counts of every step, whether or not the history has a row of it";
  void operator()(Read<measure::Overlap> overlap, Read<SolveReport> solve, Update<StepTotals> totals) const;
};

}  // namespace minamo
