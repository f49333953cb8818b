#pragma once
/// \file
/// Where the weights of a step are taken: y_p.

#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/system.hpp"

namespace minamo {

/// (E9)  y_p = x_p^n + s dt v_p^n, kept inside the box and, along periodic axes, folded into it. The share s of the
/// step is what tells these systems apart.
template <int Dim>
struct PlaceQuadratureAtStart {  // s = 0
  static constexpr Doc doc = "(E9) y_p = x_p, newmark";
  void operator()(Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p,
                  Write<particle::QuadraturePosition<Dim>> y_p) const;
};

template <int Dim>
struct PlaceQuadratureAtMiddle {  // s = 1/2
  static constexpr Doc doc = "(E9) y_p = x_p + dt/2 v_p, midpoint";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Write<particle::QuadraturePosition<Dim>> y_p) const;
};

template <int Dim>
struct PlaceQuadratureStepBefore {  // s = -1
  static constexpr Doc doc = "(E9) y_p = x_p - dt v_p, start of newmark";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Write<particle::QuadraturePosition<Dim>> y_p) const;
};

template <int Dim>
struct PlaceQuadratureStepAhead {  // s = 1
  static constexpr Doc doc = "(E9) y_p = x_p + dt v_p, initial pressure";
  void operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Write<particle::QuadraturePosition<Dim>> y_p) const;
};

}  // namespace minamo
