#pragma once
/// \file
/// The size of a vector of which every face knows the component across it.

#include "systems/liquid/spread.hpp"

#include <cmath>

namespace minamo {

/// The row of a face of direction e next to one of direction d: bit 0 of the corner below it, bit 1 above it along e.
template <int Dim>
std::optional<std::size_t> row_at_corner(const RowsOfSites<Dim>& of, std::size_t i, std::size_t d, std::size_t e,
                                         unsigned corner) {
  auto row = static_cast<std::int32_t>(i);
  if ((corner & 1U) != 0) row = of.neighbour[i][2 * d];
  if ((corner & 2U) != 0 && row != staggered::none) row = of.neighbour[static_cast<std::size_t>(row)][2 * e + 1];
  const bool by_site = of.is_near_thin_wall(i);
  if (row != staggered::none && !by_site) return static_cast<std::size_t>(row);
  if (corner != 3 && !by_site) return {};
  // The one in between may have no row.
  Index<Dim> steps{};
  if ((corner & 1U) != 0) steps[d] = -1;
  if ((corner & 2U) != 0) steps[e] = 1;
  const auto at = of.splines.site_at(of.site[i], steps);
  const auto found = at ? of.rows.find(*at) : std::nullopt;
  return found && of.parts_faces(i, d, *found, e) ? std::nullopt : found;
}

/// |q| at a face of a direction: its own component, and the means of the others over the faces around that have mass.
template <int Dim>
double size_at_face(const RowsOfSites<Dim>& of, std::span<const Vec<Dim>> m_f, std::span<const Vec<Dim>> q_f,
                    std::size_t i, std::size_t d) {
  double squares = std::pow(q_f[i][static_cast<Eigen::Index>(d)], 2);
  for (std::size_t e = 0; e < Dim; ++e) {
    if (e == d) continue;
    double sum = 0;
    double count = 0;
    for (unsigned corner = 0; corner < 4; ++corner) {
      const auto row = row_at_corner(of, i, d, e, corner);
      if (!row || m_f[*row][static_cast<Eigen::Index>(e)] == 0) continue;
      sum += q_f[*row][static_cast<Eigen::Index>(e)];
      ++count;
    }
    if (count > 0) squares += sum * sum / (count * count);
  }
  return std::sqrt(squares);
}

}  // namespace minamo
