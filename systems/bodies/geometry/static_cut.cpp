#include "systems/bodies/geometry/static_cut.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/cut_site.hpp"
#include "systems/bodies/geometry/placed_bodies.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
StaticCut<Dim> cut_by_bodies_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines) {
  StaticCut<Dim> cut;
  cut.sites = splines.sites();
  if (std::all_of(set.bodies.begin(), set.bodies.end(), [](const auto& body) { return body.moves(); })) return cut;
  const auto bodies = PlacedBodies<Dim>::at_start(set);
  const SitePlaces<Dim> places(grid, splines);
  const auto at_rest = [&](const Vec<Dim>& x) { return bodies.distance(x, false); };
  const std::size_t sites = rows_in<Dim>(cut.sites);
  const std::size_t cells = rows_in<Dim>(grid.cells);
  cut.of.resize(sites);
  for_each_costly_row(sites, [&](std::size_t i) {
    cut.of[i] = cut_site<Dim>(places, index_in<Dim>(cut.sites, i), bodies.bounded(), at_rest,
                              [&](const Vec<Dim>& x, std::size_t) { return at_rest(x); });
  });
  cut.clearance.resize(cells);
  const double half_diagonal = 0.5 * grid.spacing * std::sqrt(static_cast<double>(Dim));
  for_each_row(cells, [&](std::size_t c) {
    const Vec<Dim> x = middle_of_cell<Dim>(grid, index_in<Dim>(grid.cells, c));
    cut.clearance[c] = bodies.bounded() ? std::max(0.0, at_rest(x) - 1.1 * half_diagonal) : 0;
  });
  return cut;
}

template StaticCut<2> cut_by_bodies_at_rest<2>(const BodySet<2>&, const Grid<2>&, const Splines<2>&);
template StaticCut<3> cut_by_bodies_at_rest<3>(const BodySet<3>&, const Grid<3>&, const Splines<3>&);

}  // namespace minamo
