#pragma once
/// \file
/// (E85) What a region, of which the signed distance is known, leaves open of the faces and the multiplier of a site.

#include "systems/bodies/geometry/clip.hpp"
#include "systems/bodies/geometry/static_cut.hpp"
#include "systems/grid/site_places.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

/// Faces less open than this are closed.
inline constexpr double least_open = 1e-3;

namespace detail {

/// Samples of the volume around a multiplier, per cell and direction.
template <int Dim>
inline constexpr int volume_samples = Dim == 2 ? 8 : 2;

inline double polynomial_at(const CellSplines::Polynomial& of, double xi) {
  double value = 0;
  for (std::size_t k = of.size(); k-- > 0;) value = value * xi + of[k];
  return value;
}

/// A sample along an axis: where, and the weight of a multiplier there.
struct AxisSample {
  double place;
  double weight;
};

/// Samples of the spline j of degree K - 1.
inline std::vector<AxisSample> samples_of(const SplineAxis& axis, int degree, int j, int per_cell, double low,
                                          double spacing) {
  std::vector<AxisSample> samples;
  for (int a = degree - 1; a >= 0; --a) {
    const int cell = j - a;
    if (!axis.periodic() && (cell < 0 || cell >= axis.cells())) continue;
    const int kind_of = axis.periodic() ? (cell + axis.cells()) % axis.cells() : cell;
    for (int s = 0; s < per_cell; ++s) {
      const double xi = (s + 0.5) / per_cell;
      samples.push_back(
          {low + spacing * (cell + xi), polynomial_at(axis.of_cell(kind_of).across[static_cast<std::size_t>(a)], xi)});
    }
  }
  return samples;
}

/// Where a cell lies, as far as the distance at its middle tells: one question in place of one for every sample.
enum class CellSide : std::uint8_t { open, closed, cut };

template <int Dim, class Distance>
CellSide side_of_cell(const Vec<Dim>& middle, double half_diagonal, const Distance& distance) {
  const double at_middle = distance(middle);
  if (std::abs(at_middle) < 1.01 * half_diagonal) return CellSide::cut;
  return at_middle > 0 ? CellSide::open : CellSide::closed;
}

/// (E85)  Integral of N_l over the open volume, over that of N_l.
/// \param counts  counts(x, size): what of a sample of that size at x counts, from 0 to 1
template <int Dim, class Distance, class Counts>
double volume_share(const SitePlaces<Dim>& places, const Index<Dim>& site, bool bounded, const Distance& distance,
                    const Counts& counts) {
  const Splines<Dim>& splines = places.splines();
  const Grid<Dim>& grid = places.grid();
  constexpr std::size_t per_cell = volume_samples<Dim>;
  std::array<std::vector<AxisSample>, static_cast<std::size_t>(Dim)> samples;
  Index<Dim> cells;
  for (std::size_t d = 0; d < Dim; ++d) {
    samples[d] = samples_of(splines.axis[d], splines.degree, site[d], per_cell, grid.low[static_cast<Eigen::Index>(d)],
                            grid.spacing);
    cells[d] = static_cast<int>(samples[d].size() / per_cell);
  }
  constexpr std::size_t most_cells = power(largest_degree, Dim);
  std::array<CellSide, most_cells> side;
  side.fill(CellSide::cut);
  for (std::size_t c = 0; bounded && c < rows_in<Dim>(cells); ++c) {
    const Index<Dim> at = index_in<Dim>(cells, c);
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t first = static_cast<std::size_t>(at[d]) * per_cell;
      x[static_cast<Eigen::Index>(d)] = 0.5 * (samples[d][first].place + samples[d][first + per_cell - 1].place);
    }
    side[c] = side_of_cell<Dim>(x, 0.5 * grid.spacing * std::sqrt(static_cast<double>(Dim)), distance);
  }
  const double size = grid.spacing / static_cast<double>(per_cell);
  double open = 0;
  double all = 0;
  const auto add = [&](const Vec<Dim>& x, double weight, const Index<Dim>& cell) {
    all += weight;
    const CellSide of_cell = side[row_in<Dim>(cells, cell)];
    if (of_cell == CellSide::cut) {
      open += weight * counts(x, size) * std::clamp(0.5 + distance(x) / size, 0.0, 1.0);
    } else if (of_cell == CellSide::open) {
      open += weight * counts(x, size);
    }
  };
  const auto cell_of_sample = [](std::size_t k) { return static_cast<int>(k / per_cell); };
  for (std::size_t i = 0; i < samples[0].size(); ++i) {
    const AxisSample& a = samples[0][i];
    for (std::size_t j = 0; j < samples[1].size(); ++j) {
      const AxisSample& b = samples[1][j];
      if constexpr (Dim == 2) {
        add({a.place, b.place}, a.weight * b.weight, {cell_of_sample(i), cell_of_sample(j)});
      } else {
        for (std::size_t k = 0; k < samples[2].size(); ++k) {
          const AxisSample& c = samples[2][k];
          add({a.place, b.place, c.place}, a.weight * b.weight * c.weight,
              {cell_of_sample(i), cell_of_sample(j), cell_of_sample(k)});
        }
      }
    }
  }
  // Bodies take nothing, or all, whatever rounding says.
  constexpr double rounding = 1e-9;
  const double share = open / all;
  return share < rounding ? 0 : share > 1 - rounding ? 1 : share;
}

/// Unit vectors along the gradient of a distance, by differences to either side along every axis. They are the same but
/// where two surfaces are equally near: in the middle of a plate they point to both of its sides.
template <int Dim, class Distance>
std::array<Vec<Dim>, power(2, Dim)> normals_at(const Vec<Dim>& x, double at_x, double over, const Distance& distance) {
  Vec<Dim> forward;
  Vec<Dim> backward;
  for (int d = 0; d < Dim; ++d) {
    forward[d] = distance(x + over * Vec<Dim>::Unit(d)) - at_x;
    backward[d] = at_x - distance(x - over * Vec<Dim>::Unit(d));
  }
  std::array<Vec<Dim>, power(2, Dim)> normals;
  for (std::size_t k = 0; k < normals.size(); ++k) {
    Vec<Dim> gradient = forward;
    for (int d = 0; d < Dim; ++d) {
      if ((k >> static_cast<unsigned>(d) & 1U) != 0) gradient[d] = backward[d];
    }
    normals[k] = gradient.stableNormalized();
  }
  return normals;
}

/// Whether a point inside lies in something that is much thinner than a cell.
template <int Dim, class Distance>
bool is_in_plate(const Vec<Dim>& x, double at_x, double h, const Distance& distance) {
  if (at_x > 0 || at_x < -0.25 * h) return false;
  const auto normals = normals_at<Dim>(x, at_x, 1e-6 * h, distance);
  return std::any_of(normals.begin(), normals.end(), [&](const Vec<Dim>& n) {
    return distance(x + 0.25 * h * n) > 0 && distance(x - 0.25 * h * n) > 0;
  });
}

/// Whether a plate, or an edge sharper than 60 degrees, parts the multipliers of a face: one lies in it, or it lies
/// between them. There the liquid on one side must not flow to the other, though the face itself may be open on both;
/// so a wall of such faces has no holes.
template <int Dim, class Distance>
bool is_parted(const SitePlaces<Dim>& places, const Index<Dim>& site, std::size_t d, const Distance& distance) {
  const SplineAxis& axis = places.splines().axis[d];
  if (!places.splines().has_multiplier(site) || (site[d] == 0 && !axis.periodic())) return false;
  const double h = places.grid().spacing;
  const int below = site[d] > 0 ? site[d] - 1 : axis.multipliers() - 1;
  const Vec<Dim> high = places.middle(site);
  Vec<Dim> low = high;
  low[static_cast<Eigen::Index>(d)] -= 0.5 * h * (axis.width(site[d]) + axis.width(below));
  const double at_low = distance(low);
  const double at_high = distance(high);
  constexpr int sixtyfourth = 6;
  if (!passes_through<Dim>(low, high, at_low, at_high, sixtyfourth, distance,
                           [](const Vec<Dim>&, const Vec<Dim>&) { return false; }))
    return false;
  if (is_in_plate<Dim>(low, at_low, h, distance) || is_in_plate<Dim>(high, at_high, h, distance)) return true;
  const double over = 1e-6 * h;
  const auto of_high = normals_at<Dim>(high, at_high, over, distance);
  for (const Vec<Dim>& n : normals_at<Dim>(low, at_low, over, distance)) {
    if (std::any_of(of_high.begin(), of_high.end(), [&](const Vec<Dim>& m) { return n.dot(m) < -0.5; })) return true;
  }
  return false;
}

}  // namespace detail

/// The cut of a site by a region.
/// \param bounded           whether one distance tells of a neighbourhood (Shape::is_bounded_by_distance())
/// \param distance_at       distance_at(x) from bodies, and what is hidden from the site
/// \param distance_at_face  distance_at_face(x, d): and what is hidden from both sites of the face of direction d
template <int Dim, class Distance, class FaceDistance>
SiteCut<Dim> cut_site(const SitePlaces<Dim>& places, const Index<Dim>& site, bool bounded, const Distance& distance_at,
                      const FaceDistance& distance_at_face) {
  // Bodies often have sides along the grid: on which side of them a point of it lies is not for rounding to say.
  const auto rounded = [&](double exact) {
    constexpr double on_surface = 1e-9;  // [h]
    return std::abs(exact) < on_surface * places.grid().spacing ? 0.0 : exact;
  };
  const auto distance = [&](const Vec<Dim>& x) { return rounded(distance_at(x)); };
  const Bounds<Dim> box = places.box(site);
  SiteCut<Dim> cut;
  const bool has_multiplier = places.splines().has_multiplier(site);
  const double half_diagonal = 0.5 * places.grid().spacing * std::sqrt(static_cast<double>(Dim));  // of a cell
  if (bounded) {
    const double at_middle = distance(0.5 * (box.low + box.high));
    if (std::abs(at_middle) > places.reach()) {
      if (at_middle < 0) cut = {Vec<Dim>::Zero(), has_multiplier ? 0.0 : 1.0};
      return cut;
    }
  }
  for (std::size_t d = 0; d < Dim; ++d) {
    if (!places.splines().has_face(site, d)) continue;
    const auto axis = static_cast<Eigen::Index>(d);
    // What is farther away than a cell reaches neither cuts the face nor parts its multipliers.
    const auto of_face = [&](const Vec<Dim>& x) { return rounded(distance_at_face(x, d)); };
    const detail::CellSide side =
        bounded ? detail::side_of_cell<Dim>(places.face(site, d), half_diagonal, of_face) : detail::CellSide::cut;
    if (side != detail::CellSide::cut) {
      cut.open[axis] = side == detail::CellSide::open ? 1 : 0;
      continue;
    }
    Vec<Dim> high = box.high;
    high[axis] = box.low[axis];
    const double open = open_share<Dim>(box.low, high, static_cast<int>(d), of_face);
    cut.open[axis] = open < least_open || detail::is_parted<Dim>(places, site, d, of_face) ? 0 : open;
  }
  if (has_multiplier)
    cut.share = detail::volume_share<Dim>(places, site, bounded, distance, [](const Vec<Dim>&, double) { return 1.0; });
  return cut;
}

}  // namespace minamo
