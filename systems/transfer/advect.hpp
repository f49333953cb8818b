#pragma once
/// \file
/// Moves the particles.

#include "components/cells.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/system.hpp"

namespace minamo {

/// A point inside the box.
template <int Dim>
struct Placed {
  Vec<Dim> x;
  bool put_back;  ///< whether a wall had to hold it
};

/// The point itself, its image along periodic axes, or a point just inside the wall that it went through.
template <int Dim>
Placed<Dim> inside_box(const Grid<Dim>& grid, Vec<Dim> x);

/// (E11)  x_p^{n+1} = x_p^n + sum_I S_I(y_p) u_I. A particle that would leave the box is put back just inside the wall
/// and counted.
template <int Dim>
struct Advect {
  static constexpr std::string_view doc = "(E11) x_p; put back at walls, counted";
  void operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<particle::Configuration<Dim>> y_p,
                  Read<node::Displacement<Dim>> u_i, Update<particle::Position<Dim>> x_p,
                  Update<PutBack> put_back) const;
};

}  // namespace minamo
