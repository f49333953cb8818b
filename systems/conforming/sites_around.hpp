#pragma once
/// \file
/// Sites near a site, whether it is in a cell of particles or not.

#include "systems/conforming/splines.hpp"
#include "systems/grid/support.hpp"

namespace minamo {

/// The site next to one towards a side, 2 d below and 2 d + 1 above along axis d, if there is one.
template <int Dim>
std::optional<Index<Dim>> site_beside(const Splines<Dim>& splines, const Index<Dim>& site, std::size_t side) {
  Index<Dim> steps{};
  steps[side / 2] = side % 2 == 0 ? -1 : 1;
  return splines.site_at(site, steps);
}

/// use(other, steps) for the sites up to `Reach` steps away along every axis, x fastest, itself among them.
template <int Dim, int Reach, class Use>
void for_each_site_around(const Splines<Dim>& splines, const Index<Dim>& site, const Use& use) {
  constexpr std::size_t side = 2 * Reach + 1;
  for (std::size_t k = 0; k < power(side, Dim); ++k) {
    Index<Dim> steps;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= side) steps[d] = static_cast<int>(rest % side) - Reach;
    if (const auto other = splines.site_at(site, steps)) use(*other, steps);
  }
}

}  // namespace minamo
