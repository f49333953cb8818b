#pragma once
/// \file
/// Variational multiscale stabilization: the parameters of its cells. The matrices are those of mass_balance.hpp and
/// viscosity.hpp.
/// B. Chandra, R. Hashimoto, S. Matsumi, K. Kamrin, K. Soga, CMAME 419 (2024) 116644, doi:10.1016/j.cma.2023.116644.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E50)  tau_1 = [rho/dt + c_2 rho |v_c|/h_s + c_1 mu/h_s^2]^-1, c_1 = 4, c_2 = 2, h_s = sqrt(4 h^2/pi), v_c the
/// velocity v^n in the middle of the cell. (E51)  tau_2 = h_s^2/(c_1 tau_1).
template <int Dim>
struct FindTauVms {
  static constexpr Doc doc = "(E50) (E51) tau_c, tau_2, VMS";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<cell::Density> rho_c,
                  Read<cell::Viscosity> mu_c, Read<node::Velocity<Dim>> v_i, Write<cell::Tau> tau_c,
                  Write<cell::BulkViscosity> tau_2, Write<matrix::StabilizationScale> scale) const;
};

}  // namespace minamo
