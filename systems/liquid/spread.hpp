#pragma once
/// \file
/// The largest value of a column of multipliers around each of them.

#include "components/staggered.hpp"
#include "systems/grid/sites_around.hpp"

namespace minamo {

/// The rows of a step.
template <int Dim>
struct RowsOfSites {
  const Splines<Dim>& splines;
  const StaggeredIndex<Dim>& rows;
  std::span<const Index<Dim>> site;
  std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour;

  /// Whether a site next to one has no row, though the grid goes on.
  bool lacks_one_beside(std::size_t i) const {
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (neighbour[i][side] == staggered::none && !splines.ends_at(site[i], side)) return true;
    }
    return false;
  }
};

/// The largest value within some steps along every axis, over rows that know each other.
template <int Dim, int Reach>
void spread_over_neighbours(const RowsOfSites<Dim>& of, std::span<double> value, std::span<double> buffer) {
  for (std::size_t d = 0; d < Dim; ++d) {
    for_each_row(value.size(), [&](std::size_t i) {
      double most = value[i];
      for (std::size_t side = 2 * d; side < 2 * d + 2; ++side) {
        auto j = static_cast<std::int32_t>(i);
        for (int k = 0; k < Reach; ++k) {
          j = of.neighbour[static_cast<std::size_t>(j)][side];
          if (j == staggered::none) break;
          most = std::max(most, value[static_cast<std::size_t>(j)]);
        }
      }
      buffer[i] = most;
    });
    for_each_row(value.size(), [&](std::size_t i) { value[i] = buffer[i]; });
  }
}

/// The same over all rows: where rows between are missing those for which may_miss(row) holds look at every site
/// around. On several ranks it is that of the rows that a rank owns.
template <int Dim, int Reach, class MayMiss>
void spread_largest(const RowsOfSites<Dim>& of, std::span<double> value, std::span<double> buffer,
                    const MayMiss& may_miss) {
  const std::vector<double> of_row(value.begin(), value.end());
  spread_over_neighbours<Dim, Reach>(of, value, buffer);
  for_each_row(value.size(), [&](std::size_t i) {
    if (!may_miss(i)) return;
    for_each_row_around<Dim, Reach>(of.splines, of.rows, of.site[i], [&](std::uint32_t j, const auto&, const auto&) {
      value[i] = std::max(value[i], of_row[j]);
    });
  });
}

/// 1 where within some steps, over rows that know each other, there is a row of a kind, is_one(row); else 0. Of the
/// rows that a rank owns.
template <int Dim, int Reach, class IsOne>
std::vector<double> near_any(const RowsOfSites<Dim>& of, const IsOne& is_one) {
  std::vector<double> is_near(of.site.size());
  std::vector<double> buffer(of.site.size());
  for_each_row(is_near.size(), [&](std::size_t i) { is_near[i] = is_one(i) ? 1 : 0; });
  spread_over_neighbours<Dim, Reach>(of, is_near, buffer);
  return is_near;
}

}  // namespace minamo
