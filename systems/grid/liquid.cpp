#include "systems/grid/liquid.hpp"

#include "systems/grid/node_volume.hpp"

namespace minamo {

namespace {

constexpr double spray = 0.3;
constexpr double liquid_from = 0.5;

}  // namespace

template <int Dim>
void FindLiquid<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                 Read<node::Mass> m_i, Write<LiquidShare> liquid) const {
  liquid->of_cell.resize(cells->cells.size());
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    double mass = 0;
    for (const std::size_t i : support.node) mass += m_i[i];
    const double filled = mass / (fluid->density * full_volume<Dim>(*grid, support));
    liquid->of_cell[c] = std::clamp((filled - spray) / (liquid_from - spray), 0.0, 1.0);
  });
}

template struct FindLiquid<2>;
template struct FindLiquid<3>;

}  // namespace minamo
