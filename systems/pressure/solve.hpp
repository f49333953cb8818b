#pragma once
/// \file
/// (E79) Solves for the multipliers of a step: by a factorization where that is cheap, as it is in 2-D, else by
/// conjugate gradients with multigrid.

#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"
#include "systems/pressure/closed_components.hpp"
#include "systems/pressure/direct_solver.hpp"
#include "systems/pressure/multigrid.hpp"

#include <functional>

namespace minamo {

/// S^-1 of a step, for as many right-hand sides as come.
template <int Dim>
class MultiplierSolver {
 public:
  static constexpr ComponentInfo info{"solve.multipliers", "S^-1", "", Lifetime::scratch};
  using rows_of = Unknowns;

  /// \throws StepRejected if S is not positive definite.
  void prepare(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector);
  /// x = S^-1 b, neither with a part along null vectors, for the first so many right-hand sides of every row; the
  /// others are zero.
  /// \param tolerance  |b - S x| / |b| of every right-hand side [1]
  /// \return unknowns, iterations and the largest residual
  SolveReport solve(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector, double tolerance,
                    std::span<const Sources> b, std::span<Sources> x, std::size_t sources = most_sources);
  /// Of the matrix that was prepared.
  const ClosedComponents& closed() const { return closed_; }

  /// solve() where ranks share the matrix: of right-hand sides, solutions by unknown, for a tolerance.
  using SolveOnRanks = std::function<SolveReport(std::span<const Sources> b, std::span<Sources> x, double tolerance)>;
  /// Lets others solve from now on. (tools/mpi)
  void leave_to_ranks(ClosedComponents closed, SolveOnRanks solve) {
    closed_ = std::move(closed);
    on_ranks_ = std::move(solve);
  }

 private:
  SolveOnRanks on_ranks_;
  bool is_direct_ = true;
  ClosedComponents closed_;
  DirectSolver<Dim> direct_;
  MultigridSolver<Dim> multigrid_;
  std::vector<Sources> b_;
};

/// The matrix of a step as its solvers see it.
template <int Dim>
StaggeredLaplacian<Dim> laplacian_of(const Splines<Dim>& splines, std::span<const Index<Dim>> site,
                                     std::span<const typename StaggeredLaplacian<Dim>::Neighbours> neighbour,
                                     std::span<const typename StaggeredLaplacian<Dim>::Conductances> conductance,
                                     std::span<const double> diagonal);

template <int Dim>
struct PrepareMultipliers {
  static constexpr Doc doc = "(E79) factors or grids of S";
  void operator()(Read<Splines<Dim>> splines, Read<unknown::Site<Dim>> site, Read<unknown::Neighbour<Dim>> neighbour,
                  Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                  Read<unknown::NullVector> null_vector, Write<MultiplierSolver<Dim>> solver) const;
};

/// S x = source for the three sources of a step at once.
template <int Dim>
struct SolveMultipliers {
  static constexpr Doc doc = "(E79) S x = B v* and the other sources";
  void operator()(Read<Splines<Dim>> splines, Read<SolverTolerance> tolerance, Read<unknown::Site<Dim>> site,
                  Read<unknown::Neighbour<Dim>> neighbour, Read<unknown::Conductance<Dim>> conductance,
                  Read<unknown::Diagonal> diagonal, Read<unknown::NullVector> null_vector, Read<unknown::Source> source,
                  Update<MultiplierSolver<Dim>> solver, Write<unknown::Solution> solution,
                  Write<SolveReport> report) const;
};

}  // namespace minamo
