#pragma once
/// \file
/// (E79) on several ranks, and the projections of (E82): conjugate gradients of PETSc with an algebraic multigrid of
/// hypre.

#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/registry.hpp"
#include "engine/schedule/system.hpp"
#include "systems/pressure/solve.hpp"
#include "systems/ranks/site_exchange.hpp"
#include "systems/viscosity/multiplier_matrix.hpp"

#include <memory>

namespace minamo {

/// S of all ranks and what solves with it, kept within a step.
class PetscSolver {
 public:
  static constexpr ComponentInfo info{"ranks.petsc", "S^-1", "", Lifetime::cache};
  PetscSolver();
  ~PetscSolver();
  PetscSolver(PetscSolver&&) noexcept;
  PetscSolver& operator=(PetscSolver&&) noexcept;

  struct Impl;
  Impl& impl();

 private:
  std::unique_ptr<Impl> impl_;
};

/// S x = source for the three sources of a step; every rank has the solutions of the unknowns that it knows.
template <int Dim>
struct SolveMultipliersPetsc {
  static constexpr Doc doc = "(E79) S x = B v* and the other sources, on all ranks";
  void operator()(Read<SiteExchange> shared, Read<SolverTolerance> tolerance, Read<multiplier::Row> row,
                  Read<unknown::Staggered> of_unknown, Read<unknown::Neighbour<Dim>> neighbour,
                  Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                  Read<unknown::NullVector> null_vector, Read<unknown::Source> source, Update<PetscSolver> solver,
                  Write<MultiplierSolver<Dim>> again, Write<unknown::Solution> solution,
                  Write<SolveReport> report) const;
};

/// What projects velocities of a stiff liquid on all ranks; every rank has the solutions of the unknowns that it knows.
template <int Dim>
class PetscMultiplierMatrix final : public MultiplierMatrix<Dim> {
 public:
  using typename MultiplierMatrix<Dim>::Graph;
  void solve(std::span<const double> b, double tolerance, std::span<double> x) override;

 private:
  void start(const Splines<Dim>& splines, const Graph& graph) override;

  PetscSolver solver_;
  Graph graph_;
};

/// Makes PETSc what solves on several ranks.
void add_petsc(SystemRegistry& registry);

}  // namespace minamo
