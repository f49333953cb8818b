#pragma once
/// \file
/// Block elimination: the displacement is eliminated by the velocity block, and GMRES solves for the pressure, with a
/// factorization of a compact pressure matrix as preconditioner. Equal to UMFPACK to the tolerance; a step in which
/// GMRES does not converge, with an incomplete factorization and then with a complete one, is given to UMFPACK.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/sites.hpp"
#include "components/solver.hpp"
#include "components/step.hpp"
#include "engine/clock.hpp"
#include "engine/linear_solver.hpp"
#include "engine/system.hpp"

#include <memory>

namespace minamo {

/// Operators and factors of the last step, and work space.
template <int Dim>
struct BlockFactors {
  BlockFactors();
  ~BlockFactors();
  BlockFactors(const BlockFactors&) = delete;
  BlockFactors& operator=(const BlockFactors&) = delete;
  struct Impl;
  std::unique_ptr<Impl> impl;
  static constexpr ComponentInfo info{"solve.block_factors", "", "", Lifetime::cache};
};

/// Sets x to the solution for another right-hand side b, with the operators and factors of the last solve, in the same
/// step. \throws StepRejected as SolveBlock.
template <int Dim>
void solve_again(BlockFactors<Dim>& factors, const std::vector<double>& b, const Grid<Dim>& grid, double tolerance,
                 std::vector<double>& x);

template <int Dim>
struct SolveBlock {
  static constexpr std::string_view doc = "(E55) (E56) block elimination and GMRES, inviscid";
  /// \throws StepRejected if neither GMRES nor UMFPACK solves the system, with the size, or if iterations for the
  ///   velocities of a stiff liquid do not converge, which shorter steps help.
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                  Read<SolverTolerance> tolerance, Read<node::Row> row, Read<node::Constraint> fixed,
                  Read<node::Mass> m_i, Read<node::Pressure> p_i, Read<NodeIndex<Dim>> rows, Read<node::Site<Dim>> site,
                  Read<matrix::Node> node, Read<matrix::Divergence<Dim>> divergence,
                  Read<matrix::Stabilization<Dim>> stabilization, Read<matrix::StabilizationScale> scale,
                  Read<matrix::RightHandSide> right_hand_side, Update<WholeFactors> whole,
                  Update<BlockFactors<Dim>> factors, Write<matrix::Solution> solution, Write<SolveReport> report) const;
};

template <int Dim>
struct SolveBlockViscous {
  static constexpr std::string_view doc = "(E55) (E56) block elimination and GMRES, viscous";
  /// \throws StepRejected if neither GMRES nor UMFPACK solves the system, with the size, or if iterations for the
  ///   velocities of a stiff liquid do not converge, which shorter steps help.
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                  Read<SolverTolerance> tolerance, Read<node::Row> row, Read<node::Constraint> fixed,
                  Read<node::Mass> m_i, Read<node::Pressure> p_i, Read<NodeIndex<Dim>> rows, Read<node::Site<Dim>> site,
                  Read<matrix::Node> node, Read<matrix::Divergence<Dim>> divergence,
                  Read<matrix::Stabilization<Dim>> stabilization, Read<matrix::StabilizationScale> scale,
                  Read<matrix::Viscosity<Dim>> viscosity, Read<matrix::RightHandSide> right_hand_side,
                  Update<WholeFactors> whole, Update<BlockFactors<Dim>> factors, Write<matrix::Solution> solution,
                  Write<SolveReport> report) const;
};

}  // namespace minamo
