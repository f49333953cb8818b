#pragma once
/// \file
/// What the liquid in a cell is made of, and what follows from that for the stabilization: columns of the cells, which
/// all matrices read.

#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/parallel.hpp"
#include "engine/schedule/system.hpp"

#include <algorithm>
#include <span>

namespace minamo {

/// rho_c and mu_c are the constants of the liquid.
template <int Dim>
struct SetMaterial {
  static constexpr Doc doc = "rho_c, mu_c of one Newtonian liquid";
  void operator()(Read<Fluid> fluid, Write<cell::Density> rho_c, Write<cell::Viscosity> mu_c) const;
};

/// (E24)  tau_c = [(2 rho_c/dt)^2 + (4 mu_c/h^2)^2]^(-1/2). There is no term with |v|, which would not be Galilean
/// invariant.
template <int Dim>
struct FindTau {
  static constexpr Doc doc = "(E24) tau_c, PSPG and OSS";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<cell::Density> rho_c, Read<cell::Viscosity> mu_c,
                  Write<cell::Tau> tau_c, Write<matrix::StabilizationScale> scale) const;
};

/// What stands for all cells, of those of row c: tau_of(c), and that times rho_c.
template <class TauOf>
matrix::StabilizationScale largest_scale(std::span<const double> rho_c, const TauOf& tau_of) {
  const auto larger = [](double x, double y) { return std::max(x, y); };
  return {.pressure = reduce_rows(rho_c.size(), 0.0, tau_of, larger),
          .acceleration = reduce_rows(
              rho_c.size(), 0.0, [&](std::size_t c) { return tau_of(c) * rho_c[c]; }, larger)};
}

}  // namespace minamo
