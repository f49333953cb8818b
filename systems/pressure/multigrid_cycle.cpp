#include "systems/pressure/multigrid.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>
#include <stdexcept>

namespace minamo {

namespace {

/// Rows that a direct solver takes on.
constexpr std::size_t most_coarsest = 200;

}  // namespace

template <int Dim>
void MultigridCycle<Dim>::prepare(const StaggeredLaplacian<Dim>& matrix, std::span<const double> null_vector,
                                  const ClosedComponents& closed) {
  levels_[0].start(matrix, null_vector, closed);
  null_scale_ = 1 / reduce_rows(
                        null_vector.size(), 0.0, [&](std::size_t l) { return null_vector[l]; },
                        [](double a, double b) { return std::max(a, b); });
  count_ = 1;
  while (true) {
    if (levels_.size() == count_) levels_.emplace_back();
    MultigridLevel<Dim>& fine = levels_[count_ - 1];
    MultigridLevel<Dim>& coarse = levels_[count_++];
    coarse.start_sites(fine);
    // Far drops are not joined by more grids.
    const bool is_coarsest = coarse.rows() <= most_coarsest || 4 * coarse.rows() > 3 * fine.rows();
    is_coarsest ? coarse.keep_order() : coarse.place_by_colour();
    coarse.start_rows(fine);
    if (is_coarsest) return prepare_coarsest(coarse);
  }
}

template <int Dim>
void MultigridCycle<Dim>::prepare_coarsest(MultigridLevel<Dim>& level) {
  level.unpack();
  const StaggeredLaplacian<Dim> matrix = level.unpacked();
  ones_.assign(level.rows(), 1);
  closed_.find(matrix, ones_);
  direct_.analyse(matrix);
  coarsest_.resize(level.rows());
  if (!direct_.factorize(matrix, closed_.grounded())) {
    throw std::domain_error("multigrid: the matrix is not positive definite");
  }
}

template <int Dim>
void MultigridCycle<Dim>::solve_coarsest(MultigridLevel<Dim>& level) {
  for (std::size_t l = 0; l < level.rows(); ++l) {
    for (std::size_t s = 0; s < most_sources; ++s) coarsest_[l][s] = level.b_of(l).lane[s];
  }
  direct_.solve(coarsest_, coarsest_);
  for (std::size_t l = 0; l < level.rows(); ++l) {
    for (std::size_t s = 0; s < most_sources; ++s) level.x_of(l).lane[s] = static_cast<float>(coarsest_[l][s]);
  }
}

template <int Dim>
void MultigridCycle<Dim>::apply() {
  for (std::size_t i = 0; i + 1 < count_; ++i) {
    levels_[i].smooth_from_zero();
    levels_[i].restrict_to(levels_[i + 1]);
  }
  solve_coarsest(levels_[count_ - 1]);
  for (std::size_t i = count_ - 1; i-- > 0;) {
    levels_[i].correct_from(levels_[i + 1]);
    levels_[i].smooth_in_reverse();
  }
}

template class MultigridCycle<2>;
template class MultigridCycle<3>;

}  // namespace minamo
