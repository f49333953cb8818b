#include "systems/assemble/vms.hpp"

#include "systems/assemble/cell_matrix.hpp"

#include <cmath>
#include <numbers>

namespace minamo {

namespace {

constexpr double c_1 = 4;
constexpr double c_2 = 2;

/// tau_1 of (E50) in a cell; v_c is the velocity of the cell's own node, which lies in its middle. [m^3 s/kg]
double tau_1(double dt, double spacing, const Fluid& fluid, double speed) {
  const double h_s = spacing * std::sqrt(4 / std::numbers::pi);
  return 1 / (fluid.density / dt + c_2 * fluid.density * speed / h_s + c_1 * fluid.viscosity / (h_s * h_s));
}

/// tau_2 of (E51). [Pa s]
double tau_2(double spacing, double tau) { return 4 / std::numbers::pi * spacing * spacing / (c_1 * tau); }

}  // namespace

template <int Dim>
void StabilizeVms<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                   Read<Fluid> fluid, Read<Moments<Dim>> moments, Read<node::Row> row,
                                   Read<node::Velocity<Dim>> v_i, Read<node::BodyForce<Dim>> b_i,
                                   Read<node::KnownAcceleration<Dim>> a_known,
                                   Write<matrix::Stabilization<Dim>> stabilization,
                                   Write<matrix::StabilizationSource> source,
                                   Write<matrix::StabilizationScale> scale) const {
  // That of liquid at rest stands for all cells.
  const double at_rest = tau_1(clock->step, grid->spacing, *fluid, 0);
  *scale = {.pressure = at_rest, .acceleration = at_rest * fluid->density};
  const auto rows = stabilization.span();
  clear_rows(rows);
  for_each_row(source.size(), [&](std::size_t r) { source[r] = 0; });
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    const double tau = tau_1(clock->step, grid->spacing, *fluid, v_i[support.own()].norm());
    const double h = support.per_spacing;
    for (int d = 0; d < Dim; ++d) {
      const auto laplacian = cell_matrix<Dim>(moments->of_cell[c], slope_factors<Dim>(support.basis, d, d));
      add_to_rows<Dim>(support, row.span(), laplacian, tau * h * h, Dim + 1, Dim, rows);
      const auto gradient = cell_matrix<Dim>(moments->of_cell[c], slope_factors<Dim>(support.basis, d, -1));
      const double in_units = tau * fluid->density * h;
      add_to_rows<Dim>(support, row.span(), gradient, in_units, Dim + 1, static_cast<std::size_t>(d), rows);
      add_product<Dim>(
          support, row.span(), gradient,
          [&](std::size_t j) { return row[j] < 0 ? 0 : -in_units * (a_known[j][d] - b_i[j][d]); }, source.span());
    }
  });
}

template <int Dim>
void AddVmsBulkViscosity<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                          Read<Fluid> fluid, Read<Moments<Dim>> moments, Read<node::Row> row,
                                          Read<node::Velocity<Dim>> v_i,
                                          Update<matrix::Viscosity<Dim>> viscosity) const {
  for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    const double tau = tau_1(clock->step, grid->spacing, *fluid, v_i[support.own()].norm());
    const double scale = tau_2(grid->spacing, tau) * support.per_spacing * support.per_spacing;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        const auto matrix = cell_matrix<Dim>(moments->of_cell[c], slope_factors<Dim>(support.basis, i, j));
        add_to_rows<Dim>(support, row.span(), matrix, scale, Dim * Dim, static_cast<std::size_t>(Dim * i + j),
                         viscosity.span());
      }
    }
  });
}

template struct StabilizeVms<2>;
template struct StabilizeVms<3>;
template struct AddVmsBulkViscosity<2>;
template struct AddVmsBulkViscosity<3>;

}  // namespace minamo
