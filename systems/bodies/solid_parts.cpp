#include "systems/bodies/solid_parts.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Integral of a quadratic B-spline of spacing 1 up to t.
double below(double t) {
  const double s = std::abs(t);
  const double rest = 1.5 - s;
  double above = 0;
  if (s < 0.5) {
    above = 0.5 - s * (0.75 - s * s / 3);
  } else if (s < 1.5) {
    above = rest * rest * rest / 6;
  }
  return t < 0 ? above : 1 - above;
}

template <int Dim>
Vec<Dim> cell_middle(const Grid<Dim>& grid, const Index<Dim>& cell) {
  return grid.position(cell) + Vec<Dim>::Constant(0.5 * grid.spacing);
}

}  // namespace

template <int Dim>
void FindSolidParts<Dim>::operator()(Read<Grid<Dim>> grid, Read<GridCells<Dim>> cells, Read<StirGrid> stir,
                                     Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                                     Read<body::MiddlePosition<Dim>> c_b, Read<body::MiddleRotation<Dim>> R_b,
                                     Write<SolidParts> solid) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const double spacing = grid->spacing / stir->parts;
  // Up to the middle of the parts around a cell, and half a spline further.
  const double reach = 0.5 * std::sqrt(Dim) * (grid->spacing + spacing) + 1.5 * spacing;
  solid->place.assign(cells->cells.size(), SolidParts::none);
  std::vector<std::size_t> beside;
  for (std::size_t c = 0; c < cells->cells.size(); ++c) {
    const Index<Dim>& cell = cells->cells[c].node;
    const Vec<Dim> middle = cell_middle<Dim>(*grid, cell);
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
    const Vec<Dim> middle = cell_middle<Dim>(*grid, cell);
    for (std::size_t w = 0; w < per_window; ++w) {
      const Index<Dim> part = index_in<Dim>(side, w);
      Vec<Dim> x = middle;
      for (std::size_t d = 0; d < Dim; ++d)
        x[static_cast<Eigen::Index>(d)] += (part[d] - 0.5 * (stir->parts + 1)) * spacing;
      solid->fill[k * per_window + w] = below(-bodies.distance(x) / spacing);
    }
  });
}

template struct FindSolidParts<2>;
template struct FindSolidParts<3>;

}  // namespace minamo
