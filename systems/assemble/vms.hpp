#pragma once
/// \file
/// Variational multiscale stabilization with parameters per cell.
/// B. Chandra, R. Hashimoto, S. Matsumi, K. Kamrin, K. Soga, CMAME 419 (2024) 116644, doi:10.1016/j.cma.2023.116644.

#include "components/fluid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "engine/clock.hpp"
#include "systems/assemble/moments.hpp"

namespace minamo {

/// (E50)  sum_p tau_1 V_p grad S_I . (rho (a_p - b_p) + grad p_p) in the mass balance,
/// tau_1 = [rho/dt + c_2 rho |v_c|/h_s + c_1 mu/h_s^2]^-1, c_1 = 4, c_2 = 2, h_s = sqrt(4 h^2/pi), v_c the velocity v^n
/// in the middle of the cell.
template <int Dim>
struct StabilizeVms {
  static constexpr std::string_view doc = "(E50) VMS in the mass balance";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                  Read<Moments<Dim>> moments, Read<node::Row> row, Read<node::Velocity<Dim>> v_i,
                  Read<node::BodyForce<Dim>> b_i, Read<node::KnownAcceleration<Dim>> a_known,
                  Write<matrix::Stabilization<Dim>> stabilization, Write<matrix::StabilizationSource> source,
                  Write<matrix::StabilizationScale> scale) const;
};

/// (E51)  sum_p tau_2 V_p div v_p grad S_I in the momentum balance, tau_2 = h_s^2/(c_1 tau_1): added to K_IJ.
template <int Dim>
struct AddVmsBulkViscosity {
  static constexpr std::string_view doc = "(E51) VMS in the momentum balance";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                  Read<Moments<Dim>> moments, Read<node::Row> row, Read<node::Velocity<Dim>> v_i,
                  Update<matrix::Viscosity<Dim>> viscosity) const;
};

}  // namespace minamo
