#pragma once
/// \file
/// What the engine asks of a sparse direct solver, and what a solve reports.

#include "engine/storage/component.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace minamo {

/// Eigen's own protocol, which its wrappers of UMFPACK and CHOLMOD follow. The backend keeps its symbolic work from
/// analyzePattern() to the next, its factors from factorize() to the next.
template <class Backend, class Matrix>
concept SparseBackend = requires(Backend backend, const Matrix& matrix, const Eigen::VectorXd& b) {
  backend.analyzePattern(matrix);
  backend.factorize(matrix);
  { backend.info() } -> std::convertible_to<Eigen::ComputationInfo>;
  {backend.solve(b)};
};

/// How the linear solve of the last step went.
struct SolveReport {
  std::int64_t unknowns = 0;
  std::int64_t active = 0;      ///< places with a pressure among them
  std::int64_t iterations = 0;  ///< 0 for a direct solver
  double residual = 0;          ///< |b - A x| / |b|, euclidean [1]
  static constexpr ComponentInfo info{"solve.report", "|r|/|b|", "1", Lifetime::state};
};

}  // namespace minamo
