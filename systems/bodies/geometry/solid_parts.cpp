#include "systems/bodies/geometry/solid_parts.hpp"

#include "systems/grid/quadratic_spline.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// The parts around a cell: a window of them, one more on every side than the cell has.
template <int Dim>
struct Windows {
  const Grid<Dim>& grid;
  const PlacedBodies<Dim>& bodies;
  int parts;
  double spacing = grid.spacing / parts;  ///< of parts [m]
  Index<Dim> side = filled_index(parts + 2);
  std::size_t size = rows_in<Dim>(side);
  /// Up to the middle of the parts around a cell, and half a spline further. [m]
  double reach = 0.5 * std::sqrt(Dim) * (grid.spacing + spacing) + quadratic_spline_reach * spacing;

  static Index<Dim> filled_index(int value) {
    Index<Dim> index;
    index.fill(value);
    return index;
  }
  /// What bodies at rest, or moving ones, fill of a part of a cell.
  double fill(const Index<Dim>& cell, std::size_t w, bool moving) const {
    const Index<Dim> part = index_in<Dim>(side, w);
    Vec<Dim> x = middle_of_cell<Dim>(grid, cell);
    for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] += (part[d] - 0.5 * (parts + 1)) * spacing;
    return quadratic_spline_below(-bodies.distance(x, moving) / spacing);
  }
};

/// Finds what bodies at rest fill of cells that particles come to for the first time.
template <int Dim>
void find_resting(const Windows<Dim>& windows, const OccupiedCells<Dim>& cells, RestingParts& resting) {
  if (resting.place.empty()) resting.place.assign(rows_in<Dim>(windows.grid.cells), RestingParts::unknown);
  std::vector<std::size_t> found;
  const std::size_t before = resting.fill.size() / windows.size;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const Index<Dim>& cell = cells.cells[c].node;
    std::int32_t& place = resting.place[row_in<Dim>(windows.grid.cells, cell)];
    if (place != RestingParts::unknown) continue;
    place = RestingParts::none;
    if (windows.bodies.distance(middle_of_cell<Dim>(windows.grid, cell), false) >= windows.reach) continue;
    place = static_cast<std::int32_t>(before + found.size());
    found.push_back(c);
  }
  resting.fill.resize((before + found.size()) * windows.size);
  for_each_costly_row(found.size(), [&](std::size_t k) {
    for (std::size_t w = 0; w < windows.size; ++w)
      resting.fill[(before + k) * windows.size + w] = windows.fill(cells.cells[found[k]].node, w, false);
  });
}

}  // namespace

template <int Dim>
void FindSolidParts<Dim>::operator()(Read<Grid<Dim>> grid, Read<GridCells<Dim>> cells, Read<StirGrid> stir,
                                     Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest,
                                     Update<RestingParts> resting, Write<SolidParts> solid) const {
  const PlacedBodies<Dim> bodies(placement);
  const Windows<Dim> windows{*grid, bodies, stir->parts};
  const bool any_rests = !at_rest->of.empty();
  if (any_rests) find_resting<Dim>(windows, *cells, *resting);
  struct NearBodies {
    std::size_t cell;
    std::int32_t by_resting;
    bool by_moving;
  };
  std::vector<NearBodies> near;
  solid->place.assign(cells->cells.size(), SolidParts::none);
  for (std::size_t c = 0; c < cells->cells.size(); ++c) {
    const Index<Dim>& cell = cells->cells[c].node;
    const std::int32_t by_resting = any_rests ? resting->place[row_in<Dim>(grid->cells, cell)] : RestingParts::none;
    const bool by_moving = bodies.may_be_near(middle_of_cell<Dim>(*grid, cell), windows.reach);
    if (by_resting == RestingParts::none && !by_moving) continue;
    solid->place[c] = static_cast<std::int32_t>(near.size());
    near.push_back({c, by_resting, by_moving});
  }
  solid->fill.resize(near.size() * windows.size);
  for_each_costly_row(near.size(), [&](std::size_t k) {
    const NearBodies& of = near[k];
    for (std::size_t w = 0; w < windows.size; ++w) {
      double fill = 0;
      if (of.by_resting >= 0) fill = resting->fill[static_cast<std::size_t>(of.by_resting) * windows.size + w];
      if (of.by_moving) fill = std::max(fill, windows.fill(cells->cells[of.cell].node, w, true));
      solid->fill[k * windows.size + w] = fill;
    }
  });
}

template struct FindSolidParts<2>;
template struct FindSolidParts<3>;

}  // namespace minamo
