#include "systems/conforming/multiplier_matrix.hpp"

#include <utility>

namespace minamo {

template <int Dim>
void MultiplierMatrix<Dim>::prepare(const Incidence<Dim>& incidence, std::span<const std::uint32_t> of_unknown,
                                    Neighbours neighbour, const Values& per_d) {
  neighbour_ = neighbour;
  diagonal_.resize(of_unknown.size());
  conductance_.resize(of_unknown.size());
  for_each_row(of_unknown.size(), [&](std::size_t l) {
    const std::size_t i = of_unknown[l];
    diagonal_[l] = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t up = incidence.above(i, d);
      const double per_width = incidence.per_width(i, d);
      diagonal_[l] += per_width * per_width * (per_d[Dim * i + d] + per_d[Dim * up + d]);
      const bool has_upper = neighbour[l][2 * d + 1] != staggered::none;
      conductance_[l][d] = has_upper ? per_width * incidence.per_width(up, d) * per_d[Dim * up + d] : 0;
    }
  });
  // Between walls all around the matrix is singular; so little more changes no velocity.
  constexpr double more = 1 + 1e-11;
  cholesky_.start(diagonal_.size());
  for (std::size_t l = 0; l < diagonal_.size(); ++l) {
    for (std::size_t d = 0; d < Dim; ++d) {
      for (const std::int32_t m : {neighbour[l][2 * d], neighbour[l][2 * d + 1]}) {
        if (m == staggered::none || static_cast<std::size_t>(m) > l) continue;
        const bool is_below = m == neighbour[l][2 * d];
        cholesky_.add(l, static_cast<std::size_t>(m),
                      -(is_below ? conductance_[static_cast<std::size_t>(m)][d] : conductance_[l][d]));
      }
    }
    cholesky_.add(l, l, more * diagonal_[l]);
  }
  cholesky_.factorize(is_small() ? SparseCholesky::Kind::complete : SparseCholesky::Kind::incomplete);
}

template <int Dim>
void MultiplierMatrix<Dim>::apply(const Values& x, Values& out) const {
  for_each_row(x.size(), [&](std::size_t l) {
    double sum = diagonal_[l] * x[l];
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::int32_t low = neighbour_[l][2 * d];
      const std::int32_t high = neighbour_[l][2 * d + 1];
      if (low >= 0) sum -= conductance_[static_cast<std::size_t>(low)][d] * x[static_cast<std::size_t>(low)];
      if (high >= 0) sum -= conductance_[l][d] * x[static_cast<std::size_t>(high)];
    }
    out[l] = sum;
  });
}

template <int Dim>
void MultiplierMatrix<Dim>::solve(Values& b, Values& x) {
  const std::size_t n = b.size();
  product_.resize(n);
  if (is_small()) {
    x = b;
    cholesky_.solve(x);
    apply(x, product_);
    add_scaled(-1, product_, b);
    return;
  }
  constexpr int most = 500;
  constexpr double relative = 1e-10;
  x.assign(n, 0.0);
  direction_.assign(n, 0.0);
  const double target = relative * relative * dot(b, b);
  double before = 1;
  for (int k = 0; k < most && dot(b, b) > target; ++k) {
    preconditioned_ = b;
    cholesky_.solve(preconditioned_);
    const double now = dot(b, preconditioned_);
    const double share = k == 0 ? 0 : now / before;
    before = now;
    for_each_row(n, [&](std::size_t l) { direction_[l] = preconditioned_[l] + share * direction_[l]; });
    apply(direction_, product_);
    const double step = now / dot(direction_, product_);
    add_scaled(step, direction_, x);
    add_scaled(-step, product_, b);
  }
}

template class MultiplierMatrix<2>;
template class MultiplierMatrix<3>;

}  // namespace minamo
