#pragma once
/// \file
/// Conjugate gradients for a symmetric positive definite matrix, preconditioned with its diagonal.
/// M. R. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409, doi:10.6028/jres.049.044.

#include "systems/linear/gmres.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

namespace minamo {

/// Inner products of vectors that this process has whole.
struct LocalProducts {
  double operator()(const Values& x, const Values& y) const { return dot(x, y); }
  double weighted_square(const Values& weight, const Values& x) const { return minamo::weighted_square(weight, x); }
};

/// Work space, kept so that a solve does not allocate.
class ConjugateGradients {
 public:
  struct Report {
    std::int64_t iterations = 0;
    double residual = 0;  ///< |D^-1/2 (b - A x)|
    bool converged = false;
  };

  /// Sets x to about A^-1 r, and r to what is left of it, until |D^-1/2 r| <= target.
  /// \param apply         apply(x, out) sets out = A x
  /// \param per_diagonal  D^-1; entries that are 0 keep x at 0
  /// \param products      inner products; others than local ones where other ranks have rows, too
  template <class Apply, class Products = LocalProducts>
  Report solve(const Apply& apply, const Values& per_diagonal, double target, std::int64_t most_iterations, Values& r,
               Values& x, const Products& products = {}) {
    const std::size_t n = r.size();
    direction_.resize(n);
    product_.resize(n);
    x.assign(n, 0.0);
    for_each_row(n, [&](std::size_t i) { direction_[i] = per_diagonal[i] * r[i]; });
    Report report;
    for (double left = products.weighted_square(per_diagonal, r);; ++report.iterations) {
      report.residual = std::sqrt(left);
      report.converged = report.residual <= target;
      if (report.converged || report.iterations == most_iterations || !std::isfinite(left)) return report;
      apply(direction_, product_);
      const double step = left / products(direction_, product_);
      add_scaled(step, direction_, x);
      add_scaled(-step, product_, r);
      const double before = std::exchange(left, products.weighted_square(per_diagonal, r));
      for_each_row(n, [&](std::size_t i) { direction_[i] = per_diagonal[i] * r[i] + left / before * direction_[i]; });
    }
  }

 private:
  Values direction_;
  Values product_;
};

}  // namespace minamo
