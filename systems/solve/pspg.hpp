#pragma once
/// \file
/// Pressure-stabilizing Petrov-Galerkin (PSPG): equal-order interpolation of displacement and pressure needs a term that
/// sees the pressure modes the divergence does not see. The residual of the momentum balance, weighted by tau, is one.
/// T. E. Tezduyar et al., CMAME 95 (1992) 221, doi:10.1016/0045-7825(92)90141-6.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/step.hpp"
#include "engine/clock.hpp"
#include "engine/system.hpp"

namespace minamo {

/// (E24)  tau = [(2 rho/dt)^2 + (4 mu/h^2)^2]^(-1/2). There is no term with |v|, which would not be Galilean invariant.
template <int Dim>
struct StabilizePspg {
  static constexpr std::string_view doc = "(E24) tau, PSPG";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Write<StabilizationTime> time) const;
};

}  // namespace minamo
