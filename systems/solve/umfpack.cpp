#include "systems/solve/umfpack.hpp"

#include "engine/parallel.hpp"
#include "engine/step_control.hpp"

#include <Eigen/UmfPackSupport>

#include <spdlog/fmt/fmt.h>

namespace minamo {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
struct Backend : Eigen::UmfPackLU<Matrix> {
  /// Eigen says of all that goes wrong that the matrix is at fault.
  void require_memory() const {
    if (m_fact_errorCode == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
  }
};
static_assert(SparseBackend<Backend, Matrix>);

[[noreturn]] void reject(const char* why, Eigen::Index unknowns) {
  throw StepRejected(fmt::format("solve: {} ({} unknowns)", why, unknowns));
}

}  // namespace

struct UmfpackFactors::Impl {
  Backend backend;
  std::int64_t revision = 0;  ///< of the pattern that was analyzed
};

UmfpackFactors::UmfpackFactors() : impl(std::make_unique<Impl>()) {}
UmfpackFactors::~UmfpackFactors() = default;

SolveReport solve_monolithic(UmfpackFactors& factors, const matrix::Pattern& pattern, const std::vector<double>& values,
                             const std::vector<double>& right_hand_side, std::vector<double>& solution) {
  const auto size = static_cast<Eigen::Index>(right_hand_side.size());
  const Eigen::Map<const Matrix> matrix(size, size, static_cast<Eigen::Index>(values.size()), pattern.outer.data(),
                                        pattern.inner.data(), values.data());
  const Eigen::Map<const Eigen::VectorXd> b(right_hand_side.data(), size);
  auto& [backend, revision] = *factors.impl;
  if (revision != pattern.revision) {
    revision = 0;
    backend.analyzePattern(matrix);
    backend.require_memory();
    revision = pattern.revision;
  }
  backend.factorize(matrix);
  backend.require_memory();
  if (backend.info() != Eigen::Success) {
    reject("UMFPACK finds the matrix singular", size);
  }
  solution.resize(right_hand_side.size());
  Eigen::Map<Eigen::VectorXd> x(solution.data(), size);
  x = backend.solve(b);
  if (!x.allFinite()) reject("the solution is not finite", size);
  const double norm = b.norm();
  return {.unknowns = size, .iterations = 0, .residual = norm > 0 ? (b - matrix * x).norm() / norm : 0};
}

template <int Dim>
void SolveUmfpack<Dim>::operator()(Read<matrix::Pattern> pattern, Read<matrix::Values> values,
                                   Read<matrix::RightHandSide> right_hand_side, Update<UmfpackFactors> factors,
                                   Write<matrix::Solution> solution, Write<SolveReport> report) const {
  *report = solve_monolithic(*factors, *pattern, values->values, right_hand_side->values, solution->values);
}

void solve_again(UmfpackFactors& factors, const std::vector<double>& b, std::vector<double>& x) {
  x.resize(b.size());
  const auto size = static_cast<Eigen::Index>(b.size());
  Eigen::Map<Eigen::VectorXd> solution(x.data(), size);
  solution = factors.impl->backend.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), size));
  if (!solution.allFinite()) throw StepRejected("solve: the second solution of the step is not finite");
}

template <int Dim>
void UnpackSolution<Dim>::operator()(Read<matrix::Solution> solution, Read<node::Row> row,
                                     Update<node::Displacement<Dim>> u_i, Write<node::Pressure> p_i) const {
  for_each_row(row.size(), [&](std::size_t i) {
    p_i[i] = 0;
    if (row[i] < 0) return;
    const double* unknowns = solution->values.data() + (Dim + 1) * static_cast<std::size_t>(row[i]);
    for (int d = 0; d < Dim; ++d) u_i[i][d] += unknowns[d];
    p_i[i] = unknowns[Dim];
  });
}

template struct SolveUmfpack<2>;
template struct SolveUmfpack<3>;
template struct UnpackSolution<2>;
template struct UnpackSolution<3>;

}  // namespace minamo
