#include "systems/solve/cholesky.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/IterativeLinearSolvers>

#include <algorithm>
#include <new>

extern "C" void omp_set_max_active_levels(int);

namespace minamo {

struct SparseCholesky::Impl {
  using Matrix = Eigen::SparseMatrix<double>;
  std::vector<int> outer, inner, known_outer, known_inner;
  Values values;
  std::size_t rows = 0;
  std::vector<std::pair<int, double>> row;  ///< work space
  // Row r of the lower triangle is column r of the upper one.
  Eigen::CholmodDecomposition<Matrix, Eigen::Upper> complete;
  Eigen::IncompleteCholesky<double, Eigen::Upper, Eigen::NaturalOrdering<int>> incomplete;
  Kind kind = Kind::complete;

  void sort_rows();
  void require_memory();
  bool factorize_complete(const Eigen::Map<const Matrix>& matrix);
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {
  impl_->complete.cholmod().print = 0;  // factorize() tells
}
SparseCholesky::~SparseCholesky() = default;

void SparseCholesky::start(std::size_t rows) {
  impl_->rows = rows;
  impl_->outer.clear();
  impl_->inner.clear();
  impl_->values.clear();
}

void SparseCholesky::add(std::size_t row, std::size_t column, double value) {
  Impl& s = *impl_;
  while (s.outer.size() <= row) s.outer.push_back(static_cast<int>(s.inner.size()));
  s.inner.push_back(static_cast<int>(column));
  s.values.push_back(value);
}

void SparseCholesky::Impl::sort_rows() {
  for (std::size_t r = 0; r < rows; ++r) {
    const int begin = outer[r];
    const int end = outer[r + 1];
    if (std::is_sorted(inner.begin() + begin, inner.begin() + end)) continue;
    row.clear();
    for (int e = begin; e < end; ++e) {
      row.emplace_back(inner[static_cast<std::size_t>(e)], values[static_cast<std::size_t>(e)]);
    }
    std::sort(row.begin(), row.end());
    for (int e = begin; e < end; ++e) {
      const auto& [column, value] = row[static_cast<std::size_t>(e - begin)];
      inner[static_cast<std::size_t>(e)] = column;
      values[static_cast<std::size_t>(e)] = value;
    }
  }
}

/// What CHOLMOD has no memory for, or no 32-bit numbers, is no statement about the matrix.
void SparseCholesky::Impl::require_memory() {
  const int status = complete.cholmod().status;
  if (status != CHOLMOD_OUT_OF_MEMORY && status != CHOLMOD_TOO_LARGE) return;
  known_outer.clear();  // the analysis may be the part that is missing
  throw std::bad_alloc();
}

bool SparseCholesky::Impl::factorize_complete(const Eigen::Map<const Matrix>& matrix) {
  // CHOLMOD asks OpenMP for four threads whatever the environment says; threads are TBB's business.
  omp_set_max_active_levels(0);
  if (outer != known_outer || inner != known_inner) {
    // Dense blocks pay from a few thousand rows on.
    complete.setMode(rows < 2000 ? Eigen::CholmodSimplicialLLt : Eigen::CholmodSupernodalLLt);
    complete.analyzePattern(matrix);
    require_memory();
    known_outer = outer;
    known_inner = inner;
  }
  complete.factorize(matrix);
  require_memory();
  return complete.info() == Eigen::Success;
}

bool SparseCholesky::factorize(Kind kind) {
  Impl& s = *impl_;
  while (s.outer.size() <= s.rows) s.outer.push_back(static_cast<int>(s.inner.size()));
  s.sort_rows();
  s.kind = kind;
  const auto size = static_cast<Eigen::Index>(s.rows);
  const Eigen::Map<const Impl::Matrix> matrix(size, size, static_cast<Eigen::Index>(s.values.size()), s.outer.data(),
                                              s.inner.data(), s.values.data());
  if (kind == Kind::complete) return s.factorize_complete(matrix);
  s.incomplete.compute(matrix);
  return s.incomplete.info() == Eigen::Success;
}

void SparseCholesky::solve(Values& b) const {
  Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
  if (impl_->kind == Kind::complete) {
    x = impl_->complete.solve(x).eval();
  } else {
    x = impl_->incomplete.solve(x).eval();
  }
}

}  // namespace minamo
