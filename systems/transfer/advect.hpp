#pragma once
/// \file
/// Moves the particles with the velocity of nodes, for equal order; with that of faces it is in face_schemes.hpp. What
/// both do at the sides of the box.

#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/transfer/bundles.hpp"

namespace minamo {

/// A point inside the box.
template <int Dim>
struct Placed {
  Vec<Dim> x;
  bool clamped;  ///< whether a wall had to hold it
};

/// inside_box() of a point that may lie outside.
template <int Dim>
Placed<Dim> put_inside_box(const Grid<Dim>& grid, Vec<Dim> x);

/// The point itself, its image along periodic axes, or a point just inside the wall that it went through.
template <int Dim>
inline Placed<Dim> inside_box(const Grid<Dim>& grid, const Vec<Dim>& x) {
  bool stays = true;
  for (int d = 0; d < Dim; ++d) {
    const double margin = grid.periodic[static_cast<std::size_t>(d)] ? 0 : off_wall * grid.spacing;
    stays = stays && x[d] >= grid.low[d] + margin && x[d] <= grid.high[d] - margin;
  }
  return stays ? Placed<Dim>{x, false} : put_inside_box<Dim>(grid, x);
}

/// (E11)  x_p^{n+1} = x_p^n + sum_I S_I(y_p) u_I. A particle that would leave the box is clamped to just inside the
/// wall and counted.
template <int Dim>
struct Advect {
  static constexpr Doc doc = "(E11) x_p; clamped at walls, counted";
  void operator()(Uses<NodesToParticles<Dim>> target, Read<node::Displacement<Dim>> u_i,
                  Update<particle::Position<Dim>> x_p, Update<Clamped> clamped) const;
};

}  // namespace minamo
