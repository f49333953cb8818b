#include "systems/grid/liquid_cells.hpp"

#include <algorithm>

namespace minamo {

namespace {

constexpr double spray = 0.3;
constexpr double liquid_from = 0.5;
constexpr double bulk_from = 0.9;

double ramp(double from, double to, double x) { return std::clamp((x - from) / (to - from), 0.0, 1.0); }

}  // namespace

double liquid_indicator(double fill_fraction) { return ramp(spray, liquid_from, fill_fraction); }
double bulk_indicator(double fill_fraction) { return ramp(liquid_from, bulk_from, fill_fraction); }

template <int Dim>
void FindLiquidCells<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                      Read<node::Mass> m_i, Read<node::Capacity> capacity,
                                      Write<cell::LiquidIndicator> w_c, Write<cell::BulkIndicator> b_c) const {
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    double mass = 0;
    double volume = 0;
    for (const std::size_t i : support.node) {
      mass += m_i[i];
      volume += capacity[i];
    }
    const double fill_fraction = mass / (fluid->density * volume);
    w_c[c] = liquid_indicator(fill_fraction);
    b_c[c] = bulk_indicator(fill_fraction);
  });
}

template struct FindLiquidCells<2>;
template struct FindLiquidCells<3>;

}  // namespace minamo
