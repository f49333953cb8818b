#include "systems/linear/umfpack.hpp"

#include "engine/run/step_control.hpp"
#include "engine/schedule/parallel.hpp"

#include <Eigen/UmfPackSupport>

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <new>

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
  matrix::Monolithic matrix;
  Backend backend;
  bool is_analyzed = false;  ///< for the pattern of the matrix

  Eigen::Map<const Matrix> view() const {
    const auto size = static_cast<Eigen::Index>(matrix.outer.size()) - 1;
    return {size,
            size,
            static_cast<Eigen::Index>(matrix.values.size()),
            matrix.outer.data(),
            matrix.inner.data(),
            matrix.values.data()};
  }
};

UmfpackFactors::UmfpackFactors() : impl_(std::make_unique<Impl>()) {}
UmfpackFactors::~UmfpackFactors() = default;

void UmfpackFactors::factorize(const matrix::Monolithic& matrix) {
  auto& [own, backend, is_analyzed] = *impl_;
  is_analyzed = is_analyzed && matrix.outer == own.outer && matrix.inner == own.inner;
  own = matrix;
  const auto view = impl_->view();
  if (!is_analyzed) {
    backend.analyzePattern(view);
    backend.require_memory();
    is_analyzed = true;
  }
  backend.factorize(view);
  backend.require_memory();
  if (backend.info() != Eigen::Success) reject("UMFPACK finds the matrix singular", view.rows());
}

void UmfpackFactors::solve(const std::vector<double>& b, std::vector<double>& x) const {
  const auto matrix = impl_->view();
  const Eigen::Map<const Eigen::VectorXd> right_hand_side(b.data(), matrix.rows());
  x.resize(b.size());
  Eigen::Map<Eigen::VectorXd> solution(x.data(), matrix.rows());
  solution = impl_->backend.solve(right_hand_side);
  if (!solution.allFinite()) reject("the solution is not finite", matrix.rows());
}

SolveReport UmfpackFactors::report(const std::vector<double>& b, const std::vector<double>& x) const {
  const auto matrix = impl_->view();
  const Eigen::Map<const Eigen::VectorXd> right_hand_side(b.data(), matrix.rows());
  const Eigen::Map<const Eigen::VectorXd> solution(x.data(), matrix.rows());
  const double norm = right_hand_side.norm();
  return {.unknowns = matrix.rows(),
          .iterations = 0,
          .residual = norm > 0 ? (right_hand_side - matrix * solution).norm() / norm : 0};
}

template <int Dim>
void pack(std::span<const Vec<Dim>> f, std::span<const double> g, std::vector<double>& b) {
  b.resize((Dim + 1) * g.size());
  for_each_row(g.size(), [&](std::size_t r) {
    double* row = b.data() + (Dim + 1) * r;
    for (int d = 0; d < Dim; ++d) row[d] = f.empty() ? 0 : f[r][d];
    row[Dim] = g[r];
  });
}

template <int Dim>
void unpack(const std::vector<double>& x, std::span<Vec<Dim>> u, std::span<double> p) {
  for_each_row(u.size(), [&](std::size_t r) {
    const double* row = x.data() + (Dim + 1) * r;
    for (int d = 0; d < Dim; ++d) u[r][d] = row[d];
    if (!p.empty()) p[r] = row[Dim];
  });
}

template <int Dim>
void FactorizeUmfpack<Dim>::operator()(Read<matrix::Monolithic> matrix, Write<UmfpackFactors> factors) const {
  factors->factorize(*matrix);
}

template <int Dim>
void SolveUmfpack<Dim>::operator()(Read<UmfpackFactors> factors, Read<matrix::Momentum<Dim>> f, Read<matrix::Mass> g,
                                   Update<PackedVectors> packed, Write<matrix::Displacement<Dim>> u,
                                   Write<matrix::Pressure> p, Write<SolveReport> report) const {
  pack<Dim>(f.span(), g.span(), packed->b);
  factors->solve(packed->b, packed->x);
  *report = factors->report(packed->b, packed->x);
  report->active = static_cast<std::int64_t>(g.size());
  unpack<Dim>(packed->x, u.span(), p.span());
}

template <int Dim>
void SolveVolumeUmfpack<Dim>::operator()(Read<UmfpackFactors> factors, Read<matrix::VolumeSource> g,
                                         Update<PackedVectors> packed, Write<matrix::Shift<Dim>> d) const {
  pack<Dim>({}, g.span(), packed->b);
  factors->solve(packed->b, packed->x);
  unpack<Dim>(packed->x, d.span(), {});
}

template void pack(std::span<const Vec<2>>, std::span<const double>, std::vector<double>&);
template void pack(std::span<const Vec<3>>, std::span<const double>, std::vector<double>&);
template void unpack(const std::vector<double>&, std::span<Vec<2>>, std::span<double>);
template void unpack(const std::vector<double>&, std::span<Vec<3>>, std::span<double>);
template struct FactorizeUmfpack<2>;
template struct FactorizeUmfpack<3>;
template struct SolveUmfpack<2>;
template struct SolveUmfpack<3>;
template struct SolveVolumeUmfpack<2>;
template struct SolveVolumeUmfpack<3>;

}  // namespace minamo
