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

/// The point itself, or, if it lies outside the box, a point just inside the wall.
template <int Dim>
Vec<Dim> inside_box(const Grid<Dim>& grid, const Vec<Dim>& x);

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
