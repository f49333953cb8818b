#include "systems/equal_order/slope_matrices.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// The three kinds of dual cells of an axis.
constexpr std::array<const AxisBasis*, 3> all_bases{&low_wall_basis, &inner_basis, &high_wall_basis};

}  // namespace

template <int Dim>
SlopeMatrices<Dim>::SlopeMatrices(const SupportBox<Dim>& support, const Moments<Dim>& moments, std::size_t c)
    : basis_(&support.basis), moments_(&moments.of_cell[c]), full_(nullptr), volume_(1) {
  if (moments.is_filled[c] == 0) return;
  full_ = &of_full_cell(support.basis);
  for (int d = 0; d < Dim; ++d) volume_ /= support.per_spacing;
}

template <int Dim>
const typename SlopeMatrices<Dim>::Matrices& SlopeMatrices<Dim>::of_full_cell(const CellBasis<Dim>& basis) {
  static const std::vector<Matrices> all = [] {
    std::vector<Matrices> made(power(3, Dim));
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& kind) {
      CellBasis<Dim> bases;
      for (std::size_t d = 0; d < bases.size(); ++d) bases[d] = all_bases[static_cast<std::size_t>(kind[d])];
      std::array<double, support_size<Dim>> full;
      full.fill(1);
      const CellMoments<Dim> moments = integrate_theta<Dim>(bases, full);
      std::size_t place = 0;
      for (int j = 0; j < Dim; ++j) made[k][place++] = cell_matrix<Dim>(moments, slope_factors<Dim>(bases, -1, j));
      for (int i = 0; i < Dim; ++i) {
        for (int j = i; j < Dim; ++j) made[k][place++] = cell_matrix<Dim>(moments, slope_factors<Dim>(bases, i, j));
      }
    });
    return made;
  }();
  std::size_t k = 0;
  for (std::size_t d = Dim; d-- > 0;) {
    const auto* const found = std::find(all_bases.begin(), all_bases.end(), basis[d]);
    k = 3 * k + static_cast<std::size_t>(found - all_bases.begin());
  }
  return all[k];
}

template class SlopeMatrices<2>;
template class SlopeMatrices<3>;

}  // namespace minamo
