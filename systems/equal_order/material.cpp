#include "systems/equal_order/material.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
void SetMaterial<Dim>::operator()(Read<Fluid> fluid, Write<cell::Density> rho_c, Write<cell::Viscosity> mu_c) const {
  for_each_row(rho_c.size(), [&](std::size_t c) {
    rho_c[c] = fluid->density;
    mu_c[c] = fluid->viscosity;
  });
}

template <int Dim>
void FindTau<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<cell::Density> rho_c,
                              Read<cell::Viscosity> mu_c, Write<cell::Tau> tau_c,
                              Write<matrix::StabilizationScale> scale) const {
  for_each_row(tau_c.size(), [&](std::size_t c) {
    tau_c[c] = 1 / std::hypot(2 * rho_c[c] / clock->step, 4 * mu_c[c] / (grid->spacing * grid->spacing));
  });
  *scale = largest_scale(rho_c.span(), [&](std::size_t c) { return tau_c[c]; });
}

template struct SetMaterial<2>;
template struct SetMaterial<3>;
template struct FindTau<2>;
template struct FindTau<3>;

}  // namespace minamo
