#pragma once
/// \file
/// From where a face looks at the liquid that is continued into bodies: walls hide what is on their other side.

#include "components/staggered.hpp"
#include "systems/grid/sites_around.hpp"

namespace minamo {

/// The more open one of the two multipliers of a face, that at its own site where they are alike.
/// \param open  shares of multipliers, by row
template <int Dim>
Index<Dim> side_of_face(const Splines<Dim>& splines, std::span<const Index<Dim>> site,
                        std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour,
                        std::span<const double> open, std::size_t i, std::size_t d) {
  const auto below = adjacent_site(splines, site[i], 2 * d);
  if (!below) return site[i];
  if (!splines.has_multiplier(site[i])) return *below;
  const std::int32_t row = neighbour[i][2 * d];
  return row != staggered::none && open[static_cast<std::size_t>(row)] > open[i] ? *below : site[i];
}

}  // namespace minamo
