#pragma once
/// \file
/// The staggered grid for kernels one at a time, and B-splines by their recursion, to compare with.

#include "support/kernels.hpp"

#include "components/staggered.hpp"
#include "systems/grid/number_sites.hpp"
#include "systems/grid/splines.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace minamo::kernels {

/// The B-spline i of a degree at r, in units of h from the low end of an axis. C. de Boor, J. Approx. Theory 6 (1972)
/// 50. Knots are open between walls, and the integers along a periodic axis, where i counts from the support that
/// begins `degree` cells before the low end.
inline double plain_spline(int cells, bool periodic, int degree, int i, double r) {
  const auto recursion = [&](double at) {
    std::vector<double> knot;
    for (int m = -degree; m <= cells + degree; ++m) knot.push_back(periodic ? m : std::clamp(m, 0, cells));
    const auto last = static_cast<std::size_t>(cells + degree);
    std::vector<double> value(knot.size() - 1, 0.0);
    for (std::size_t k = 0; k < value.size(); ++k) {
      const bool at_end = at == cells && k + 1 == last;
      if (knot[k] < knot[k + 1] && knot[k] <= at && (at < knot[k + 1] || at_end)) value[k] = 1;
    }
    for (int p = 1; p <= degree; ++p) {
      const auto q = static_cast<std::size_t>(p);
      for (std::size_t k = 0; k + q + 1 < knot.size(); ++k) {
        const double rise = knot[k + q] - knot[k];
        const double fall = knot[k + q + 1] - knot[k + 1];
        const double low = rise > 0 ? (at - knot[k]) / rise * value[k] : 0;
        value[k] = low + (fall > 0 ? (knot[k + q + 1] - at) / fall * value[k + 1] : 0);
      }
    }
    return value[static_cast<std::size_t>(i)];
  };
  // The image that lies before the low end belongs to the high one.
  if (periodic && r > i + 1) return r - cells < i + 1 && r - cells > i - degree ? recursion(r - cells) : 0;
  return recursion(r);
}

/// 7, 5, 4 cells, around in x if so wished.
template <int Dim>
Grid<Dim> staggered_grid(bool periodic) {
  Grid<Dim> grid = small_grid<Dim>();
  grid.periodic[0] = periodic;
  return grid;
}

enum class Slip { everywhere, nowhere };

/// Numbers the staggered sites of the particles, which it sorts.
template <int Dim>
void number_staggered(World& world) {
  run<BinByCell<Dim>>(world);
  run<NumberSites<Dim>>(world);
}

/// Particles with random masses at random places, at least `away` cells from walls, on the staggered grid.
template <int Dim>
void fill_staggered(World& world, const Grid<Dim>& grid, int degree, std::size_t count, std::uint64_t seed,
                    Slip walls = Slip::nowhere, double away = 0) {
  world.resource<Grid<Dim>>() = grid;
  world.resource<Fluid>() = {1000, 0};
  world.resource<Splines<Dim>>() = make_splines(grid, degree);
  auto& held = world.resource<Walls<Dim>>().held;
  for (std::size_t d = 0; d < Dim; ++d) {
    const bool holds = walls == Slip::everywhere && !grid.periodic[d];
    held[d] = {static_cast<std::uint8_t>(holds ? 1U << d : 0U), static_cast<std::uint8_t>(holds ? 1U << d : 0U)};
  }
  world.resize<Particles>(count);
  Random random(seed);
  const Vec<Dim> margin = Vec<Dim>::Constant(away * grid.spacing);
  for (std::size_t p = 0; p < count; ++p) {
    const Vec<Dim> y = random_place<Dim>(random, grid, p);
    world.column<particle::QuadraturePosition<Dim>>()[p] = y.cwiseMax(grid.low + margin).cwiseMin(grid.high - margin);
    world.column<particle::Mass>()[p] = random(0.5, 1.5);
    world.column<particle::Id>()[p] = static_cast<std::int64_t>(p);
  }
  set_volumes(world);
  number_staggered<Dim>(world);
}

/// Greville point of the face of direction d at a site. [m]
template <int Dim>
Vec<Dim> face_position(World& world, const Index<Dim>& site, int d) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const Splines<Dim>& splines = world.resource<Splines<Dim>>();
  Vec<Dim> x;
  for (int e = 0; e < Dim; ++e) {
    const auto axis = static_cast<std::size_t>(e);
    const int cell = std::min(site[axis], grid.cells[axis] - 1);
    const CellSplines& of = splines.axis[axis].of_cell(cell);
    const auto a = static_cast<std::size_t>(site[axis] - cell);
    x[e] = grid.low[e] + grid.spacing * (cell + (d == e ? of.along_place[a] : of.across_place[a]));
  }
  return x;
}

/// use(row, d, Greville point) for all faces that there are.
template <int Dim, class Use>
void for_each_face_of(World& world, const Use& use) {
  const Splines<Dim>& splines = world.resource<Splines<Dim>>();
  const auto site = world.column<staggered::Site<Dim>>();
  for (std::size_t i = 0; i < site.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      if (splines.has_face(site[i], static_cast<std::size_t>(d))) use(i, d, face_position<Dim>(world, site[i], d));
    }
  }
}

}  // namespace minamo::kernels
