#pragma once
/// \file
/// The velocity gradients that particles carry, where the grid does not resolve them.

#include "components/cells.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E73)  grad v_p min(1, c/(dt |grad v_p|)), c = 0.05 + 0.45 w_c, w_c (E61). In spray a face may weigh next to
/// nothing, and what is around it moves by more than a cell against it in a step. Such a gradient is noise, and what it
/// gives to the faces comes back as energy.
template <int Dim>
struct LimitGradient {
  static constexpr Doc doc = "(E73) velocity gradients, where the grid does not resolve them";
  void operator()(Read<Clock> clock, Read<GridCells<Dim>> cells, Read<cell::LiquidIndicator> w_c,
                  Update<particle::VelocityGradient<Dim>> grad_v_p) const;
};

}  // namespace minamo
