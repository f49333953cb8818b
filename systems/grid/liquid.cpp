#include "systems/grid/liquid.hpp"

#include <algorithm>

namespace minamo {

namespace {

constexpr double spray = 0.3;
constexpr double liquid_from = 0.5;
constexpr double bulk_from = 0.9;

double ramp(double from, double to, double x) { return std::clamp((x - from) / (to - from), 0.0, 1.0); }

}  // namespace

double liquid_share(double fill_fraction) { return ramp(spray, liquid_from, fill_fraction); }

template <int Dim>
void FindLiquid<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                 Read<node::Mass> m_i, Read<node::Capacity> capacity, Write<LiquidShare> liquid) const {
  liquid->of_cell.resize(cells->cells.size());
  liquid->interior.resize(cells->cells.size());
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    double mass = 0;
    double volume = 0;
    for (const std::size_t i : support.node) {
      mass += m_i[i];
      volume += capacity[i];
    }
    const double fill_fraction = mass / (fluid->density * volume);
    liquid->of_cell[c] = liquid_share(fill_fraction);
    liquid->interior[c] = ramp(liquid_from, bulk_from, fill_fraction);
  });
}

template struct FindLiquid<2>;
template struct FindLiquid<3>;

}  // namespace minamo
