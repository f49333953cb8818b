#include "systems/equal_order/vms.hpp"

#include "systems/equal_order/material.hpp"
#include "systems/grid/node_support.hpp"

#include <cmath>
#include <numbers>

namespace minamo {

namespace {

constexpr double c_1 = 4;
constexpr double c_2 = 2;

}  // namespace

template <int Dim>
void FindTauVms<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                 Read<cell::Density> rho_c, Read<cell::Viscosity> mu_c, Read<node::Velocity<Dim>> v_i,
                                 Write<cell::Tau> tau_c, Write<cell::BulkViscosity> tau_2,
                                 Write<matrix::StabilizationScale> scale) const {
  const double h_s = grid->spacing * std::sqrt(4 / std::numbers::pi);
  const auto tau_1 = [&](std::size_t c, double speed) {
    return 1 / (rho_c[c] / clock->step + c_2 * rho_c[c] * speed / h_s + c_1 * mu_c[c] / (h_s * h_s));
  };
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    tau_c[c] = tau_1(c, v_i[Support<Dim>(*grid, cell).own()].norm());
    tau_2[c] = 4 / std::numbers::pi * grid->spacing * grid->spacing / (c_1 * tau_c[c]);
  });
  *scale = largest_scale(rho_c.span(), [&](std::size_t c) { return tau_1(c, 0); });
}

template struct FindTauVms<2>;
template struct FindTauVms<3>;

}  // namespace minamo
