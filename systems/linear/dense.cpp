#include "systems/linear/dense.hpp"

#include <Eigen/Cholesky>

#include <limits>
#include <vector>

// Of LAPACK, which comes without a header in C.
extern "C" {
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* ipiv, int* info);
void dgetri_(const int* n, double* a, const int* lda, const int* ipiv, double* work, const int* lwork, int* info);
void dsysv_(const char* uplo, const int* n, const int* nrhs, double* a, const int* lda, int* ipiv, double* b,
            const int* ldb, double* work, const int* lwork, int* info, std::size_t);
void dsygv_(const int* itype, const char* jobz, const char* uplo, const int* n, double* a, const int* lda, double* b,
            const int* ldb, double* w, double* work, const int* lwork, int* info, std::size_t, std::size_t);
}

namespace minamo {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Enough for blocks of 64 rows.
std::vector<double> workspace(int n) { return std::vector<double>(static_cast<std::size_t>(64 * n + 1)); }

}  // namespace

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd inverse = A;
  const int n = static_cast<int>(A.rows());
  if (n == 0) return inverse;
  std::vector<int> pivots(static_cast<std::size_t>(n));
  std::vector<double> work = workspace(n);
  const int size = static_cast<int>(work.size());
  int info = 0;
  dgetrf_(&n, &n, inverse.data(), &n, pivots.data(), &info);
  if (info == 0) dgetri_(&n, inverse.data(), &n, pivots.data(), work.data(), &size, &info);
  if (info != 0) inverse.setConstant(nan);
  return inverse;
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Eigen::MatrixXd factors = A;
  Eigen::VectorXd x = b;
  const int n = static_cast<int>(A.rows());
  if (n == 0) return x;
  std::vector<int> pivots(static_cast<std::size_t>(n));
  std::vector<double> work = workspace(n);
  const int size = static_cast<int>(work.size());
  const int one = 1;
  int info = 0;
  dsysv_("L", &n, &one, factors.data(), &n, pivots.data(), x.data(), &n, work.data(), &size, &info, 1);
  if (info != 0) x.setConstant(nan);
  return x;
}

template <int N>
Eigen::Matrix<double, N, 1> solve_small_symmetric(const Eigen::Matrix<double, N, N>& A,
                                                  const Eigen::Matrix<double, N, 1>& b) {
  return A.ldlt().solve(b);
}

Modes modes_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  Modes modes{Eigen::VectorXd(A.rows()), A};
  Eigen::MatrixXd factor = B;
  const int n = static_cast<int>(A.rows());
  if (n == 0) return modes;
  std::vector<double> work = workspace(n);
  const int size = static_cast<int>(work.size());
  const int first_kind = 1;
  int info = 0;
  dsygv_(&first_kind, "V", "L", &n, modes.V.data(), &n, factor.data(), &n, modes.lambda.data(), work.data(), &size,
         &info, 1, 1);
  if (info != 0) modes.lambda.setConstant(nan);
  return modes;
}

template Eigen::Matrix<double, 2, 1> solve_small_symmetric<2>(const Eigen::Matrix<double, 2, 2>&,
                                                              const Eigen::Matrix<double, 2, 1>&);
template Eigen::Matrix<double, 3, 1> solve_small_symmetric<3>(const Eigen::Matrix<double, 3, 3>&,
                                                              const Eigen::Matrix<double, 3, 1>&);
template Eigen::Matrix<double, 4, 1> solve_small_symmetric<4>(const Eigen::Matrix<double, 4, 4>&,
                                                              const Eigen::Matrix<double, 4, 1>&);

}  // namespace minamo
