#include "systems/linear/cholesky.hpp"

#include <Eigen/CholmodSupport>

#include <algorithm>
#include <new>

extern "C" void omp_set_max_active_levels(int);

namespace minamo {

struct SparseCholesky::Impl {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<Eigen::Triplet<double>> entries;
  Matrix matrix, analyzed;
  Eigen::CholmodDecomposition<Matrix, Eigen::Lower> factors;

  bool is_analyzed() const;
  void require_memory();
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {
  impl_->factors.cholmod().print = 0;     // factorize() tells
  impl_->factors.cholmod().final_ll = 1;  // with LDL^T CHOLMOD would not tell
}
SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::start(std::size_t rows) {
  const auto size = static_cast<Eigen::Index>(rows);
  impl_->matrix.resize(size, size);
  impl_->entries.clear();
}

void SparseCholesky::add(std::size_t row, std::size_t column, double value) {
  impl_->entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
}

/// Whether the symbolic factorization is that of the pattern.
bool SparseCholesky::Impl::is_analyzed() const {
  const auto are_same = [](const int* a, const int* b, Eigen::Index count) { return std::equal(a, a + count, b); };
  return matrix.cols() == analyzed.cols() && matrix.nonZeros() == analyzed.nonZeros() &&
         are_same(matrix.outerIndexPtr(), analyzed.outerIndexPtr(), matrix.cols()) &&
         are_same(matrix.innerIndexPtr(), analyzed.innerIndexPtr(), matrix.nonZeros());
}

/// What CHOLMOD has no memory for, or no 32-bit numbers, is no statement about the matrix.
void SparseCholesky::Impl::require_memory() {
  const int status = factors.cholmod().status;
  if (status != CHOLMOD_OUT_OF_MEMORY && status != CHOLMOD_TOO_LARGE) return;
  analyzed.resize(0, 0);  // the analysis may be the part that is missing
  throw std::bad_alloc();
}

bool SparseCholesky::factorize() {
  Impl& s = *impl_;
  // CHOLMOD asks OpenMP for four threads whatever the environment says; threads are TBB's business.
  omp_set_max_active_levels(0);
  s.matrix.setFromTriplets(s.entries.begin(), s.entries.end());
  if (!s.is_analyzed()) {
    s.factors.analyzePattern(s.matrix);
    s.require_memory();
    s.analyzed = s.matrix;
  }
  s.factors.factorize(s.matrix);
  s.require_memory();
  return s.factors.info() == Eigen::Success;
}

void SparseCholesky::solve(Values& b) const {
  Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
  x = impl_->factors.solve(x).eval();
}

}  // namespace minamo
