#include "systems/conforming/multiplier_matrix.hpp"

#include "engine/parallel.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Up to this many operations factors are cheaper than as many cycles of multigrid as a step has solves.
constexpr double most_direct_work = 1e8;
/// Of a projection: directions without divergence need not be more exact than the velocity that they add up to.
constexpr double projection_tolerance = 1e-10;
constexpr std::int64_t most_cycles = 100;

}  // namespace

template <int Dim>
void MultiplierMatrix<Dim>::prepare(const Splines<Dim>& splines, const Incidence<Dim>& incidence, const Graph& graph,
                                    std::span<const double> per_d) {
  const std::size_t n = graph.staggered.size();
  diagonal_.resize(n);
  conductance_.resize(n);
  b_.assign(n, {});
  x_.assign(n, {});
  for_each_row(n, [&](std::size_t l) {
    const std::size_t i = graph.staggered[l];
    diagonal_[l] = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t up = incidence.above(i, d);
      const double per_width = incidence.per_width(i, d);
      diagonal_[l] += per_width * per_width * (per_d[Dim * i + d] + per_d[Dim * up + d]);
      const bool has_upper = graph.neighbour[l][2 * d + 1] != staggered::none;
      conductance_[l][d] = has_upper ? per_width * incidence.per_width(up, d) * per_d[Dim * up + d] : 0;
    }
  });
  matrix_ = {graph.site, graph.neighbour, conductance_, diagonal_, splines.sites(), {}};
  for (std::size_t d = 0; d < Dim; ++d) matrix_.periodic[d] = splines.axis[d].periodic();
  null_vector_ = graph.null_vector;
  if (n == 0) return;
  closed_.find(matrix_, null_vector_);
  is_direct_ = direct_.analyse(matrix_) <= most_direct_work && direct_.factorize(matrix_, closed_.grounded());
  if (!is_direct_) multigrid_.prepare(matrix_, null_vector_, closed_);
}

template <int Dim>
void MultiplierMatrix<Dim>::solve(std::span<const double> b, std::span<double> x) {
  if (b.empty()) return;
  for (std::size_t l = 0; l < b.size(); ++l) b_[l][0] = b[l];
  closed_.remove_null_part(null_vector_, b_);
  if (is_direct_) {
    direct_.solve(b_, x_);
  } else {
    multigrid_.solve({matrix_, null_vector_, b_, 1, projection_tolerance}, x_, most_cycles);
  }
  for (std::size_t l = 0; l < b.size(); ++l) x[l] = x_[l][0];
}

template class MultiplierMatrix<2>;
template class MultiplierMatrix<3>;

}  // namespace minamo
