#pragma once
/// \file
/// UMFPACK on the monolithic system: the reference that other solvers are measured against.
/// Timothy A. Davis, Algorithm 832: UMFPACK V4.3, ACM TOMS 30 (2004) 196, doi:10.1145/992200.992206.

#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/linear_solver.hpp"
#include "engine/system.hpp"

#include <memory>

namespace minamo {

/// Symbolic and numeric factors; the symbolic ones live as long as the pattern does.
struct UmfpackFactors {
  UmfpackFactors();
  ~UmfpackFactors();
  UmfpackFactors(const UmfpackFactors&) = delete;
  UmfpackFactors& operator=(const UmfpackFactors&) = delete;
  struct Impl;
  std::unique_ptr<Impl> impl;
  static constexpr ComponentInfo info{"solve.umfpack_factors", "", "", Lifetime::cache};
};

/// Factorizes the monolithic matrix and solves.
/// \throws StepRejected if the matrix is singular or the solution is not finite, with the size.
SolveReport solve_monolithic(UmfpackFactors& factors, const matrix::Pattern& pattern, const std::vector<double>& values,
                             const std::vector<double>& right_hand_side, std::vector<double>& solution);

/// Sets x to the solution for another right-hand side b, by the factors of the last factorization.
/// \throws StepRejected if it is not finite.
void solve_again(UmfpackFactors& factors, const std::vector<double>& b, std::vector<double>& x);

template <int Dim>
struct SolveUmfpack {
  static constexpr std::string_view doc = "solve the monolithic system by UMFPACK";
  /// \throws StepRejected if the matrix is singular or the solution is not finite, with the size.
  void operator()(Read<matrix::Pattern> pattern, Read<matrix::Values> values,
                  Read<matrix::RightHandSide> right_hand_side, Update<UmfpackFactors> factors,
                  Write<matrix::Solution> solution, Write<SolveReport> report) const;
};

/// u_I and p_I from the solution.
template <int Dim>
struct UnpackSolution {
  static constexpr std::string_view doc = "u_I and p_I from the solution";
  void operator()(Read<matrix::Solution> solution, Read<node::Row> row, Update<node::Displacement<Dim>> u_i,
                  Write<node::Pressure> p_i) const;
};

}  // namespace minamo
