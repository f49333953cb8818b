#include "systems/grid/liquid.hpp"

#include "systems/grid/node_volume.hpp"

namespace minamo {

namespace {

constexpr double spray = 0.3;
constexpr double liquid_from = 0.5;
constexpr double bulk_from = 0.9;

double ramp(double from, double to, double x) { return std::clamp((x - from) / (to - from), 0.0, 1.0); }

/// f_c of (E61).
template <int Dim>
double filling(const Grid<Dim>& grid, const SupportBox<Dim>& around, double density, double mass) {
  return mass / (density * full_volume<Dim>(grid, around));
}

}  // namespace

template <int Dim>
double liquid_share(const Grid<Dim>& grid, const SupportBox<Dim>& around, double density, double mass) {
  return ramp(spray, liquid_from, filling<Dim>(grid, around, density, mass));
}

template <int Dim>
void FindLiquid<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                 Read<node::Mass> m_i, Write<LiquidShare> liquid) const {
  liquid->of_cell.resize(cells->cells.size());
  liquid->interior.resize(cells->cells.size());
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    double mass = 0;
    for (const std::size_t i : support.node) mass += m_i[i];
    const double filled = filling<Dim>(*grid, support, fluid->density, mass);
    liquid->of_cell[c] = ramp(spray, liquid_from, filled);
    liquid->interior[c] = ramp(liquid_from, bulk_from, filled);
  });
}

template double liquid_share<2>(const Grid<2>&, const SupportBox<2>&, double, double);
template double liquid_share<3>(const Grid<3>&, const SupportBox<3>&, double, double);
template struct FindLiquid<2>;
template struct FindLiquid<3>;

}  // namespace minamo
