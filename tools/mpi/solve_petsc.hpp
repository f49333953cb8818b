#pragma once
/// \file
/// (E79) on several ranks: conjugate gradients of PETSc with an algebraic multigrid of hypre.

#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/linear_solver.hpp"
#include "engine/system.hpp"
#include "systems/conforming/staggered_laplacian.hpp"
#include "systems/ranks/site_exchange.hpp"

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
  static constexpr std::string_view doc = "(E79) S x = B v* and the other sources, on all ranks";
  void operator()(Read<SiteExchange> shared, Read<SolverTolerance> tolerance, Read<multiplier::Row> row,
                  Read<unknown::Staggered> of_unknown, Read<unknown::Neighbour<Dim>> neighbour,
                  Read<unknown::Conductance<Dim>> conductance, Read<unknown::Diagonal> diagonal,
                  Read<unknown::NullVector> null_vector, Read<unknown::Source> source, Update<PetscSolver> solver,
                  Write<unknown::Solution> solution, Write<SolveReport> report) const;
};

}  // namespace minamo
