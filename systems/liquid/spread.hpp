#pragma once
/// \file
/// The largest value of a column of multipliers around each of them.

#include "components/staggered.hpp"
#include "systems/ranks/site_exchange.hpp"

namespace minamo {

/// The largest value within some steps along every axis, over rows that know each other.
template <int Dim>
void spread_largest(std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour, int reach,
                    const Optional<Read<SiteExchange>>& shared, std::span<double> value, std::span<double> buffer) {
  for (std::size_t d = 0; d < Dim; ++d) {
    for_each_row(value.size(), [&](std::size_t i) {
      double most = value[i];
      for (std::size_t side = 2 * d; side < 2 * d + 2; ++side) {
        auto j = static_cast<std::int32_t>(i);
        for (int k = 0; k < reach; ++k) {
          j = neighbour[static_cast<std::size_t>(j)][side];
          if (j == staggered::none) break;
          most = std::max(most, value[static_cast<std::size_t>(j)]);
        }
      }
      buffer[i] = most;
    });
    for_each_row(value.size(), [&](std::size_t i) { value[i] = buffer[i]; });
    if (shared) shared->copy_from_owner(value);
  }
}

}  // namespace minamo
