#pragma once
/// \file
/// S x = b by conjugate gradients with geometric multigrid as preconditioner: for large problems in 3-D. Aggregates
/// of 2^d sites, piecewise constant corrections, Gauss-Seidel by colour before and, in reverse, after them, a direct
/// solver on the coarsest grid. Galerkin's matrices of piecewise constants are too stiff, hence weaker ones: D. Braess,
/// Computing 55 (1995) 379, doi:10.1007/BF02238488. The same bits on any number of threads. All that is global is sums
/// and maxima, but for the coarsest grid.

#include "systems/pressure/direct_solver.hpp"
#include "systems/pressure/multigrid_level.hpp"

namespace minamo {

/// Numbers of as many right-hand sides, side by side.
template <int Width>
struct LaneRow {
  using Lanes [[gnu::vector_size(Width * sizeof(double))]] = double;
  Lanes lane;
};
/// Work space of the iteration.
template <int Width>
struct LockstepVectors {
  std::vector<LaneRow<Width>> r;  ///< b - S x
  std::vector<LaneRow<Width>> x;
  std::vector<LaneRow<Width>> p;  ///< direction
  std::vector<LaneRow<Width>> q;  ///< S p
};

/// The V-cycle: a symmetric positive definite approximation of S^-1, up to a factor.
template <int Dim>
class MultigridCycle {
 public:
  /// \param null_vector  n_l > 0: N S N, N = diag(n), is the matrix of a graph: S n = 0 but at the free surface
  /// \throws std::domain_error if the matrix is not positive definite
  void prepare(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
               const ClosedComponents& closed);
  /// finest().x = about (N S N)^-1 finest().b, up to a factor
  void apply();
  MultigridLevel<Dim>& finest() { return levels_.front(); }
  std::size_t level_count() const { return count_; }
  /// 1 / largest n_l: right-hand sides times this and n have the size of residuals.
  double null_scale() const { return null_scale_; }

 private:
  void prepare_coarsest(MultigridLevel<Dim>& level);
  void solve_coarsest(MultigridLevel<Dim>& level);

  std::vector<MultigridLevel<Dim>> levels_{1};  ///< kept, with their memory, when there are fewer
  std::size_t count_ = 0;
  double null_scale_ = 1;
  DirectSolver<Dim> direct_;
  ClosedComponents closed_;
  std::vector<double> ones_;
  std::vector<Sources> coarsest_;
};

template <int Dim>
struct MultigridProblem {
  const StaggeredLaplacian<Dim>& matrix;
  std::span<const double> null_vector;  ///< as MultigridCycle::prepare() has it
  std::span<const Sources> b;           ///< without null parts, ClosedComponents::remove_null_part()
  std::size_t sources = most_sources;   ///< the first of every row; the others are not read
  double tolerance = 1e-8;              ///< |b - S x| / |b| of every right-hand side, euclidean [1]
};

struct MultigridReport {
  std::int64_t iterations = 0;
  double residual = 0;  ///< largest |b - S x| / |b|, of b itself and not of the iteration [1]
};

template <int Dim>
class MultigridSolver {
 public:
  /// As MultigridCycle::prepare().
  void prepare(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
               const ClosedComponents& closed);
  /// Solves for all right-hand sides at once, from x = 0. One that is zero has the solution zero.
  /// \pre prepare() has seen the matrix and the null vector
  MultigridReport solve(const MultigridProblem<Dim>& problem, std::span<Sources> x, std::int64_t most_iterations);
  std::size_t level_count() const { return cycle_.level_count(); }

 private:
  template <int Width>
  MultigridReport solve_side_by_side(const MultigridProblem<Dim>& problem, std::span<Sources> x,
                                     std::int64_t most_iterations, LockstepVectors<Width>& vectors);

  MultigridCycle<Dim> cycle_;
  LockstepVectors<2> two_;
  LockstepVectors<4> four_;
};

}  // namespace minamo
