#include "systems/bodies/particles/keep_out.hpp"

#include "systems/bodies/geometry/clip.hpp"
#include "systems/bodies/particles/stops.hpp"
#include "systems/grid/lattice.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/transfer/advect.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

namespace minamo {

namespace {

/// Distance that particles keep from bodies, in units of h.
constexpr double gap = 1e-3;
/// From this depth in a body on, in units of h, faces around a particle are closed, and what it takes of them no
/// pressure has done. Less deep ones are found out at the end of the step.
constexpr double deep = 0.1;
/// Of those that a particle in a corner takes, two are enough between two plane walls.
constexpr int most_tries = 16;

/// How a point leaves a body that it is `depth` too near to, along its normal n; out of a corner along the wall that
/// held it before, or the one would push it into the other for ever.
template <int Dim>
Vec<Dim> way_out(const Vec<Dim>& n, double depth, const std::optional<Vec<Dim>>& held_by, double most) {
  constexpr double parallel = 1e-6;
  Vec<Dim> way = n;
  if (held_by && held_by->dot(n) < 0) {
    const double towards = held_by->dot(n);
    const double square = 1 - towards * towards;
    if (square > parallel) way = (n - towards * *held_by) / square;
  }
  return std::min(depth, most / way.norm()) * way;
}

/// A point inside the box: one that lies beyond a side of it comes back along the wall with normal n, or it would go
/// through a plate.
template <int Dim>
Placed<Dim> back_along_wall(const Grid<Dim>& grid, const Vec<Dim>& n, const Vec<Dim>& x) {
  Vec<Dim> back = x;
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)]) continue;
    const double margin = off_wall * grid.spacing;
    const double below = grid.low[d] + margin - back[d];
    const double above = back[d] - grid.high[d] + margin;
    if (below > 0) back += way_out<Dim>(Vec<Dim>::Unit(d), below, n, grid.spacing);
    if (above > 0) back += way_out<Dim>(-Vec<Dim>::Unit(d), above, n, grid.spacing);
  }
  return {put_inside_box<Dim>(grid, back).x, back != x};
}

/// From one point to another, across the ends of periodic axes where that is shorter. [m]
template <int Dim>
Vec<Dim> way_between(const Grid<Dim>& grid, const Vec<Dim>& from, const Vec<Dim>& to) {
  Vec<Dim> way = to - from;
  for (int d = 0; d < Dim; ++d) {
    const double length = grid.high[d] - grid.low[d];
    if (grid.periodic[static_cast<std::size_t>(d)]) way[d] -= length * std::round(way[d] / length);
  }
  return way;
}

/// The farthest that bodies carry a point of the grid from one of their places to another: a corner, as no way of a
/// rigid motion is longer than those of the corners around it. [m]
template <int Dim>
double farthest_move(const Grid<Dim>& grid, std::size_t bodies, const PlacedBodies<Dim>& from,
                     const PlacedBodies<Dim>& to) {
  double farthest = 0;
  for (std::size_t b = 0; b < bodies; ++b) {
    for (unsigned corner = 0; corner < (1U << static_cast<unsigned>(Dim)); ++corner) {
      Vec<Dim> x = grid.low;
      for (int d = 0; d < Dim; ++d) {
        if ((corner >> static_cast<unsigned>(d) & 1U) != 0) x[d] = grid.high[d];
      }
      farthest = std::max(farthest, (to.placement(b).to_world(from.placement(b).to_body(x)) - x).norm());
    }
  }
  return farthest;
}

/// Where a way ends that leads into a plate and beyond its middle, or through it: at the last point outside, or at the
/// surface that a point inside is nearest to. None of other ways: from a thick body a particle finds out by itself, on
/// the side that it came from.
template <int Dim>
std::optional<Vec<Dim>> end_before_plate(const Shape<Dim>& shape, const Vec<Dim>& from, const Vec<Dim>& to) {
  const double at_from = shape.distance(from);
  if (at_from + shape.distance(to) >= (to - from).norm()) return {};
  const Vec<Dim> side = shape.gradient(from);
  const double to_other_side = side.dot(shape.gradient(to));
  if (at_from <= 0) {
    if (to_other_side >= 0) return {};
    return from - at_from / side.squaredNorm() * side;
  }
  if (to_other_side > 0) return {};
  constexpr int steps = 16;
  constexpr int halvings_of_step = 4;
  const auto distance = [&](const Vec<Dim>& x) { return shape.distance(x); };
  // A plate thinner than pieces are lies between its sides.
  const auto changes_side = [&](const Vec<Dim>& a, const Vec<Dim>& b) {
    return shape.gradient(a).dot(shape.gradient(b)) < 0;
  };
  Vec<Dim> before = from;
  double at_before = at_from;
  for (int k = 1; k <= steps; ++k) {
    const Vec<Dim> x = from + (static_cast<double>(k) / steps) * (to - from);
    const double at_x = distance(x);
    if (passes_through<Dim>(before, x, at_before, at_x, halvings_of_step, distance, changes_side)) return before;
    before = x;
    at_before = at_x;
  }
  return {};
}

/// The nearest point of the surface, of a point at least so deep inside. None of others.
template <int Dim>
std::optional<Vec<Dim>> surface_above(const Shape<Dim>& shape, const Vec<Dim>& x, double depth) {
  const double distance = shape.distance(x);
  if (distance > -depth) return {};
  const Vec<Dim> gradient = shape.gradient(x);
  if (gradient.isZero(0)) return {};
  return x - distance / gradient.squaredNorm() * gradient;
}

/// The body nearest to a point, if one may be within `reach` of it.
template <int Dim>
typename PlacedBodies<Dim>::Nearest nearest_within(const Grid<Dim>& grid, const StaticCut<Dim>& at_rest,
                                                   const PlacedBodies<Dim>& bodies, const Vec<Dim>& x, double reach) {
  typename PlacedBodies<Dim>::Nearest nearest;
  if (at_rest.clearance_of(grid, cell_of<Dim>(grid, x)) <= reach) nearest = bodies.nearest(x, false);
  if (!bodies.may_be_near(x, reach)) return nearest;
  const auto moving = bodies.nearest(x, true);
  return moving.distance < nearest.distance ? moving : nearest;
}

}  // namespace

template <int Dim>
void StopAtPlates<Dim>::operator()(Read<Grid<Dim>> grid, Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                                   Read<body::Position<Dim>> c_b, Read<body::Rotation<Dim>> R_b,
                                   Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b,
                                   Read<body::MiddlePosition<Dim>> c_middle, Read<body::MiddleRotation<Dim>> R_middle,
                                   Read<particle::Mass> m_p, Read<particle::Position<Dim>> x_p,
                                   Update<particle::QuadraturePosition<Dim>> y_p, Update<particle::Velocity<Dim>> v_p,
                                   Optional<Read<Ranks>> ranks, Write<body::PlateImpulse<Dim>> J_b,
                                   Update<body::Work> W_b) const {
  const PlacedBodies<Dim> at_start(*set, c_b.span(), R_b.span());
  const PlacedBodies<Dim> in_middle(*set, c_middle.span(), R_middle.span());
  const double move = farthest_move<Dim>(*grid, set->bodies.size(), at_start, in_middle);
  Stops<Dim> stops(*set, R_b.span(), c_b.span(), V_b.span(), omega_b.span());
  for_each_row(x_p.size(), [&](std::size_t p) {
    const Vec<Dim> way = way_between<Dim>(*grid, x_p[p], y_p[p]);
    const auto nearest = nearest_within<Dim>(*grid, *at_rest, at_start, x_p[p], way.norm() + move);
    if (nearest.body < 0 || nearest.distance <= 0) return;
    const auto b = static_cast<std::size_t>(nearest.body);
    const Shape<Dim>& shape = *set->bodies[b].shape;
    const Placement<Dim>& middle = in_middle.placement(b);
    const Vec<Dim> from = at_start.placement(b).to_body(x_p[p]);
    const Vec<Dim> to = middle.to_body(x_p[p] + way);
    auto end = end_before_plate<Dim>(shape, from, to);
    if (!end && set->bodies[b].free() == nullptr) end = surface_above<Dim>(shape, to, deep * grid->spacing);
    if (!end) return;
    const Vec<Dim> n = middle.direction_to_world(shape.gradient(*end)).stableNormalized();
    y_p[p] = fold<Dim>(*grid, back_along_wall<Dim>(*grid, n, middle.to_world(*end)).x);
    stops.stop(p, b, x_p[p], n, v_p[p]);
  });
  stops.give(m_p.span(), J_b.span(), ranks);
  for (std::size_t b = 0; b < J_b.size(); ++b) {
    if (set->bodies[b].free() != nullptr) J_b[b].setZero();
    W_b[b] += J_b[b].dot(rigid_vector<Dim>(V_b[b], omega_b[b]));
  }
}

template <int Dim>
void KeepOutOfBodies<Dim>::operator()(Read<Grid<Dim>> grid, Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                                      Read<GridCells<Dim>> cells, Read<body::MiddlePosition<Dim>> c_middle,
                                      Read<body::MiddleRotation<Dim>> R_middle, Read<body::Position<Dim>> c_b,
                                      Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_b,
                                      Read<body::Spin<Dim>> omega_b, Read<particle::Mass> m_p,
                                      Read<particle::QuadraturePosition<Dim>> y_p, Update<particle::Position<Dim>> x_p,
                                      Update<particle::Velocity<Dim>> v_p, Update<Clamped> clamped,
                                      Optional<Read<Ranks>> ranks, Write<body::StopImpulse<Dim>> J_b) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const PlacedBodies<Dim> in_middle(*set, c_middle.span(), R_middle.span());
  const double move = farthest_move<Dim>(*grid, set->bodies.size(), in_middle, bodies);
  const double least = gap * grid->spacing;
  Stops<Dim> stops(*set, R_b.span(), c_b.span(), V_b.span(), omega_b.span());
  const auto stop_before_plate = [&](std::size_t p) {
    const Vec<Dim> way = way_between<Dim>(*grid, y_p[p], x_p[p]);
    const auto nearest = nearest_within<Dim>(*grid, *at_rest, in_middle, y_p[p], way.norm() + move);
    if (nearest.body < 0) return false;
    const auto b = static_cast<std::size_t>(nearest.body);
    const Shape<Dim>& shape = *set->bodies[b].shape;
    const Vec<Dim> from = in_middle.placement(b).to_body(y_p[p]);
    const auto end = end_before_plate<Dim>(shape, from, bodies.placement(b).to_body(y_p[p] + way));
    if (!end) return false;
    const Vec<Dim> n = bodies.placement(b).direction_to_world(shape.gradient(*end)).stableNormalized();
    x_p[p] = back_along_wall<Dim>(*grid, n, bodies.placement(b).to_world(*end)).x;
    stops.stop(p, b, x_p[p], n, v_p[p]);
    return true;
  };
  std::atomic<std::int64_t> count = 0;
  const auto keep_out = [&](std::size_t p) {
    bool was_inside = stop_before_plate(p);
    std::optional<Vec<Dim>> held_by;
    for (int k = 0; k < most_tries; ++k) {
      const auto nearest = nearest_within<Dim>(*grid, *at_rest, bodies, x_p[p], least);
      if (nearest.distance >= least) break;
      const auto b = static_cast<std::size_t>(nearest.body);
      const Vec<Dim> gradient = bodies.placement(b).gradient(*set->bodies[b].shape, x_p[p]);
      const double steepness = gradient.norm();
      if (steepness == 0) break;
      const Vec<Dim> n = gradient / steepness;
      const Vec<Dim> away =
          x_p[p] + way_out<Dim>(n, (1.01 * least - nearest.distance) / steepness, held_by, grid->spacing);
      const Placed<Dim> placed = back_along_wall<Dim>(*grid, n, away);
      x_p[p] = placed.x;
      held_by = placed.clamped ? Vec<Dim>((placed.x - away).normalized()) : n;
      if (nearest.distance >= 0) continue;
      was_inside = true;
      stops.stop(p, b, x_p[p], n, v_p[p]);
    }
    if (was_inside) ++count;
  };
  // Most cells are so far from bodies that no particle of them gets there within a step.
  const double within = std::max(grid->spacing, move);  // that no moving body is
  const double half_diagonal = 0.5 * grid->spacing * std::sqrt(static_cast<double>(Dim));
  const double reach = 1.1 * (within + half_diagonal);
  const bool any_moves = set->any_moves();
  for_each_cell<Dim>(*cells, [&](std::size_t, const auto& cell) {
    double clearance = at_rest->clearance_of(*grid, cell.node);
    const Vec<Dim> middle = middle_of_cell<Dim>(*grid, cell.node);
    if (any_moves) {
      const bool is_near = bodies.may_be_near(middle, reach) || in_middle.may_be_near(middle, reach);
      clearance = is_near ? 0 : std::min(clearance, within);
    }
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      if ((x_p[p] - y_p[p]).squaredNorm() >= clearance * clearance) keep_out(p);
    }
  });
  clamped->count += count;
  stops.share(m_p.span(), v_p.span(), ranks);
  stops.give(m_p.span(), J_b.span(), ranks);
}

template struct StopAtPlates<2>;
template struct StopAtPlates<3>;
template struct KeepOutOfBodies<2>;
template struct KeepOutOfBodies<3>;

}  // namespace minamo
