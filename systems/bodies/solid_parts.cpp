#include "systems/bodies/solid_parts.hpp"

#include "systems/conforming/quadratic_spline.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
void FindSolidParts<Dim>::operator()(Read<Grid<Dim>> grid, Read<GridCells<Dim>> cells, Read<StirGrid> stir,
                                     Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                                     Read<body::MiddlePosition<Dim>> c_b, Read<body::MiddleRotation<Dim>> R_b,
                                     Write<SolidParts> solid) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const double spacing = grid->spacing / stir->parts;
  // Up to the middle of the parts around a cell, and half a spline further.
  const double reach = 0.5 * std::sqrt(Dim) * (grid->spacing + spacing) + quadratic_spline_reach * spacing;
  solid->place.assign(cells->cells.size(), SolidParts::none);
  std::vector<std::size_t> beside;
  for (std::size_t c = 0; c < cells->cells.size(); ++c) {
    const Index<Dim>& cell = cells->cells[c].node;
    const Vec<Dim> middle = middle_of_cell<Dim>(*grid, cell);
    const bool by_resting = !at_rest->of.empty() && bodies.distance(middle, false) < reach;
    if (!by_resting && !bodies.may_be_near(middle, reach)) continue;
    solid->place[c] = static_cast<std::int32_t>(beside.size());
    beside.push_back(c);
  }
  Index<Dim> side;
  side.fill(stir->parts + 2);
  const std::size_t per_window = rows_in<Dim>(side);
  solid->fill.resize(beside.size() * per_window);
  for_each_row(beside.size(), [&](std::size_t k) {
    const Index<Dim>& cell = cells->cells[beside[k]].node;
    const Vec<Dim> middle = middle_of_cell<Dim>(*grid, cell);
    for (std::size_t w = 0; w < per_window; ++w) {
      const Index<Dim> part = index_in<Dim>(side, w);
      Vec<Dim> x = middle;
      for (std::size_t d = 0; d < Dim; ++d)
        x[static_cast<Eigen::Index>(d)] += (part[d] - 0.5 * (stir->parts + 1)) * spacing;
      solid->fill[k * per_window + w] = quadratic_spline_below(-bodies.distance(x) / spacing);
    }
  });
}

template struct FindSolidParts<2>;
template struct FindSolidParts<3>;

}  // namespace minamo
