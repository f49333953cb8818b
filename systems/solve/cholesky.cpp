#include "systems/solve/cholesky.hpp"

#include <Eigen/CholmodSupport>

extern "C" void omp_set_max_active_levels(int);

namespace minamo {

struct SparseCholesky::Impl {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<int> outer, inner, known_outer, known_inner;
  Values values;
  std::size_t rows = 0;
  // Row r of the lower triangle is column r of the upper one.
  Eigen::CholmodDecomposition<Matrix, Eigen::Upper> backend;
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {
  impl_->backend.cholmod().print = 0;  // factorize() tells
}
SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::start(std::size_t rows) {
  impl_->rows = rows;
  impl_->outer.clear();
  impl_->inner.clear();
  impl_->values.clear();
}

void SparseCholesky::add(std::size_t row, std::size_t column, double value) {
  auto& [outer, inner, a, b, values, rows, backend] = *impl_;
  while (outer.size() <= row) outer.push_back(static_cast<int>(inner.size()));
  auto at = inner.size();
  inner.push_back(static_cast<int>(column));
  values.push_back(value);
  const auto first = static_cast<std::size_t>(outer.back());
  for (; at > first && inner[at - 1] > inner[at]; --at) {
    std::swap(inner[at - 1], inner[at]);
    std::swap(values[at - 1], values[at]);
  }
}

bool SparseCholesky::factorize() {
  // CHOLMOD asks OpenMP for four threads whatever the environment says; threads are TBB's business.
  omp_set_max_active_levels(0);
  auto& [outer, inner, known_outer, known_inner, values, rows, backend] = *impl_;
  while (outer.size() <= rows) outer.push_back(static_cast<int>(inner.size()));
  const auto size = static_cast<Eigen::Index>(rows);
  const Eigen::Map<const Impl::Matrix> matrix(size, size, static_cast<Eigen::Index>(values.size()), outer.data(),
                                              inner.data(), values.data());
  if (outer != known_outer || inner != known_inner) {
    // Dense blocks pay from a few thousand rows on.
    backend.setMode(rows < 2000 ? Eigen::CholmodSimplicialLLt : Eigen::CholmodSupernodalLLt);
    backend.analyzePattern(matrix);
    known_outer = outer;
    known_inner = inner;
  }
  backend.factorize(matrix);
  return backend.info() == Eigen::Success;
}

void SparseCholesky::solve(Values& b) {
  Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
  x = impl_->backend.solve(x).eval();
}

}  // namespace minamo
