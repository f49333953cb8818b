#pragma once
/// \file
/// (E88) Liquid that walls and bodies enclose all around, and that moving ones, or inflow, leave less room, or more.

#include "components/body.hpp"
#include "components/openings.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/pressure/solve.hpp"

#include <span>
#include <vector>

namespace minamo {

/// How full an enclosed volume is before there is no room; with less, bubbles are left that give way.
inline constexpr double full_enclosure = 0.95;
/// Of what walls press into a liquid here and there, the share that counts as a change of its room. A body that moves
/// inside leaves none, up to rounding.
inline constexpr double least_change_of_room = 1e-2;

/// Which closed components of a matrix are full, by their number less one.
std::vector<bool> full_components(const ClosedComponents& closed, std::span<const std::uint32_t> of_unknown,
                                  std::span<const double> v_l, std::span<const double> capacity);

/// (E88)  Rejects the step if walls and inflow together squeeze or stretch a closed component that is full: its balance
/// of mass has no solution, for sum_l n_l (B (c w_b + a w_f))_l is not zero, and what (E79) takes from the right-hand
/// side would stay as divergence. Free bodies that have no way out have stopped by then, (E92). \throws StepRejected
/// naming the rate
template <int Dim>
struct RequireRoom {
  static constexpr Doc doc = "(E88) reject the step if bodies squeeze liquid that is enclosed";
  void operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<body::MiddlePosition<Dim>> c_b,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b, Read<face::Closed<Dim>> closed,
                  Read<face::Closer<Dim>> closer, Read<face::Open<Dim>> open, Optional<Read<face::Prescribed<Dim>>> w_f,
                  Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                  Read<unknown::Staggered> of_unknown, Read<unknown::NullVector> n_l,
                  Read<MultiplierSolver<Dim>> solver) const;
};

}  // namespace minamo
