#pragma once
/// \file
/// The largest value of a column of multipliers around each of them.

#include "components/staggered.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/sites_around.hpp"

namespace minamo {

/// The dry sides of bodies, if they hide anything that is wet, too.
template <int Dim>
const DrySides<Dim>* hiding(const Optional<Read<DrySides<Dim>>>& dry) {
  return dry && dry->hides_any() ? &*dry : nullptr;
}

/// The rows of a step.
template <int Dim>
struct RowsOfSites {
  const Splines<Dim>& splines;
  const StaggeredIndex<Dim>& rows;
  std::span<const Index<Dim>> site;
  std::span<const typename staggered::Neighbour<Dim>::value_type> neighbour;
  const DrySides<Dim>* dry = nullptr;  ///< null: no thin wall hides anything

  /// Whether a thin wall may part a row from those around: their sites tell, not which rows know each other.
  bool is_near_thin_wall(std::size_t i) const { return dry != nullptr && dry->has_view(site[i]); }
  bool parts(std::size_t i, std::uint32_t j) const { return dry != nullptr && dry->parts(site[i], site[j]); }
  /// Whether one parts a face of direction d from a face of direction e: all their sites.
  bool parts_faces(std::size_t i, std::size_t d, std::size_t j, std::size_t e) const {
    if (dry == nullptr) return false;
    const auto below_i = adjacent_site(splines, site[i], 2 * d);
    const auto below_j = adjacent_site(splines, site[j], 2 * e);
    return dry->parts(site[i], site[j]) && (!below_i || dry->parts(*below_i, site[j])) &&
           (!below_j || (dry->parts(site[i], *below_j) && (!below_i || dry->parts(*below_i, *below_j))));
  }

  /// Whether a site next to one has no row, though the grid goes on.
  bool lacks_neighbour(std::size_t i) const {
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
/// around that no thin wall parts from theirs. On several ranks it is that of the rows that a rank owns.
/// \param enough  from which on nobody asks how much more it is
template <int Dim, int Reach, class MayMiss>
void spread_largest(const RowsOfSites<Dim>& of, std::span<double> value, std::span<double> buffer, double enough,
                    const MayMiss& may_miss) {
  const std::vector<double> of_row(value.begin(), value.end());
  spread_over_neighbours<Dim, Reach>(of, value, buffer);
  for_each_row(value.size(), [&](std::size_t i) {
    if (of.is_near_thin_wall(i)) {
      value[i] = of_row[i];
    } else if (value[i] >= enough || !may_miss(i)) {
      return;
    }
    for_each_row_around<Dim, Reach>(of.splines, of.rows, of.site[i], [&](std::uint32_t j, const auto&, const auto&) {
      if (!of.parts(i, j)) value[i] = std::max(value[i], of_row[j]);
      return value[i] < enough;
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
