#pragma once
/// \file
/// GMRES with restarts and a preconditioner on the right, so that the residual is that of the system itself. The
/// preconditioned directions are kept: where rounding makes the preconditioner not quite linear, the correction is
/// still the one whose residual was found.
/// Y. Saad, SIAM J. Sci. Comput. 14 (1993) 461, doi:10.1137/0914028 (flexible GMRES).

#include "engine/schedule/parallel.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace minamo {

using Values = std::vector<double>;

inline double dot(const Values& x, const Values& y) {
  return reduce_rows(
      x.size(), 0.0, [&](std::size_t i) { return x[i] * y[i]; }, std::plus<>());
}

/// sum_i weight_i x_i^2
inline double weighted_square(const Values& weight, const Values& x) {
  return reduce_rows(
      x.size(), 0.0, [&](std::size_t i) { return weight[i] * x[i] * x[i]; }, std::plus<>());
}

inline void add_scaled(double scale, const Values& x, Values& y) {
  for_each_row(x.size(), [&](std::size_t i) { y[i] += scale * x[i]; });
}

/// Work space, kept so that a solve does not allocate.
class Gmres {
 public:
  struct Report {
    std::int64_t iterations = 0;
    double residual = 0;  ///< |b - A x|
    bool converged = false;
  };

  enum class Start { zero, x };

  /// Improves x until |b - A x| <= target.
  /// \param start         whether x holds something near, or is set to zero
  /// \param apply         apply(x, out, allowed) sets out = A x; errors up to `allowed` in |out| do no harm, which grow
  ///   as the residual falls (A. Bouras, V. Fraysse, SIAM J. Matrix Anal. Appl. 26 (2005) 660)
  /// \param precondition  precondition(x, out) sets out to about A^-1 x
  template <class Apply, class Precondition>
  Report solve(const Apply& apply, const Precondition& precondition, const Values& b, double target,
               std::int64_t most_iterations, Start start, Values& x) {
    resize(b.size());
    Report report;
    if (start == Start::zero) std::fill(x.begin(), x.end(), 0.0);
    while (true) {
      if (start == Start::zero && report.iterations == 0) {
        basis_[0] = b;
      } else {
        apply(x, product_, share_of_errors * target);
        for_each_row(b.size(), [&](std::size_t i) { basis_[0][i] = b[i] - product_[i]; });
      }
      report.residual = std::sqrt(dot(basis_[0], basis_[0]));
      report.converged = report.residual <= target;
      if (report.converged || report.iterations >= most_iterations || !std::isfinite(report.residual)) return report;
      const std::size_t size = cycle(apply, precondition, target, most_iterations, report);
      add_correction(size, x);
    }
  }

 private:
  static constexpr std::size_t restart = 50;
  static constexpr double share_of_errors = 0.5;  ///< of the target

  void resize(std::size_t rows) {
    if (product_.size() == rows) return;
    product_.resize(rows);
    basis_.resize(restart + 1);
    direction_.resize(restart);
    for (Values& v : basis_) v.resize(v.empty() ? 0 : rows);
    for (Values& v : direction_) v.resize(v.empty() ? 0 : rows);
    basis_[0].resize(rows);
  }

  /// One more of the vectors that a cycle needs; most cycles need few.
  Values& grown(std::vector<Values>& vectors, std::size_t k) {
    vectors[k].resize(product_.size());
    return vectors[k];
  }

  /// Builds up to `restart` basis vectors from the residual in the first, and the triangular system of their weights.
  template <class Apply, class Precondition>
  std::size_t cycle(const Apply& apply, const Precondition& precondition, double target, std::int64_t most_iterations,
                    Report& report) {
    scale(1 / report.residual, basis_[0]);
    rest_[0] = report.residual;
    std::size_t k = 0;
    while (k < restart && report.iterations < most_iterations && !report.converged) {
      Values& direction = grown(direction_, k);
      precondition(basis_[k], direction);
      Values& next = grown(basis_, k + 1);
      apply(direction, next, share_of_errors * target / report.residual);
      auto& column = hessenberg_[k];
      for (std::size_t j = 0; j <= k; ++j) {
        column[j] = dot(next, basis_[j]);
        add_scaled(-column[j], basis_[j], next);
      }
      const double length = std::sqrt(dot(next, next));
      if (length > 0) scale(1 / length, next);
      rotate(k, length);
      ++k;
      ++report.iterations;
      report.residual = std::abs(rest_[k]);
      report.converged = report.residual <= target || length == 0;
    }
    return k;
  }

  /// Givens rotations make column k triangular.
  void rotate(std::size_t k, double length) {
    auto& column = hessenberg_[k];
    for (std::size_t j = 0; j < k; ++j) {
      const double above = column[j];
      column[j] = cosine_[j] * above + sine_[j] * column[j + 1];
      column[j + 1] = -sine_[j] * above + cosine_[j] * column[j + 1];
    }
    const double radius = std::hypot(column[k], length);
    cosine_[k] = radius > 0 ? column[k] / radius : 1;
    sine_[k] = radius > 0 ? length / radius : 0;
    column[k] = radius;
    rest_[k + 1] = -sine_[k] * rest_[k];
    rest_[k] *= cosine_[k];
  }

  void add_correction(std::size_t size, Values& x) {
    std::array<double, restart> weight{};
    for (std::size_t k = size; k-- > 0;) {
      double sum = rest_[k];
      for (std::size_t j = k + 1; j < size; ++j) sum -= hessenberg_[j][k] * weight[j];
      weight[k] = hessenberg_[k][k] != 0 ? sum / hessenberg_[k][k] : 0;
    }
    for (std::size_t k = 0; k < size; ++k) add_scaled(weight[k], direction_[k], x);
  }

  static void scale(double factor, Values& x) {
    for_each_row(x.size(), [&](std::size_t i) { x[i] *= factor; });
  }

  std::vector<Values> basis_;
  std::vector<Values> direction_;  ///< M^-1 of the basis vectors
  Values product_;
  std::array<std::array<double, restart + 1>, restart> hessenberg_{};
  std::array<double, restart> cosine_{};
  std::array<double, restart> sine_{};
  std::array<double, restart + 1> rest_{};
};

}  // namespace minamo
