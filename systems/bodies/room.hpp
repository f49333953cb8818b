#pragma once
/// \file
/// (E88) Liquid that walls and bodies enclose all around, and that moving ones leave less room, or more.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "engine/clock.hpp"
#include "engine/system.hpp"
#include "systems/conforming/solve.hpp"
#include "systems/conforming/splines.hpp"

namespace minamo {

/// (E88)  Rejects the step if walls squeeze or stretch a closed component that is full: its balance of mass has no
/// solution, for sum_l n_l (B c w)_l is not zero, and what (E79) takes from the right-hand side would stay as
/// divergence.
/// \throws StepRejected naming the volume and its rate
template <int Dim>
struct RequireRoom {
  static constexpr std::string_view doc = "(E88) reject the step if bodies squeeze liquid that is enclosed";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<staggered::Site<Dim>> site,
                  Read<staggered::Neighbour<Dim>> neighbour, Read<face::WallFlux<Dim>> flux,
                  Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                  Read<unknown::Staggered> of_unknown, Read<unknown::NullVector> n_l,
                  Read<MultiplierSolver<Dim>> solver) const;
};

}  // namespace minamo
