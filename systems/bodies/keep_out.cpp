#include "systems/bodies/keep_out.hpp"

#include "systems/bodies/clip.hpp"
#include "systems/grid/support.hpp"
#include "systems/setup/lattice.hpp"
#include "systems/transfer/advect.hpp"

#include <atomic>
#include <cmath>
#include <optional>

namespace minamo {

namespace {

/// Distance that particles keep from bodies, in units of h.
constexpr double gap = 1e-3;
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

/// The last point outside of a way that leads into a plate, or through it to its other side; none of other ways. From a
/// thick body a particle finds out by itself, on the side that it came from.
template <int Dim>
std::optional<Vec<Dim>> end_before_plate(const Shape<Dim>& shape, const Vec<Dim>& from, const Vec<Dim>& to) {
  const auto distance = [&](const Vec<Dim>& x) { return shape.distance(x); };
  const double at_from = distance(from);
  const double at_to = distance(to);
  if (at_from <= 0 || at_from + at_to >= (to - from).norm()) return {};
  if (shape.gradient(from).dot(shape.gradient(to)) > 0) return {};
  constexpr int steps = 16;
  constexpr int halvings_of_step = 4;
  Vec<Dim> before = from;
  for (int k = 1; k <= steps; ++k) {
    const Vec<Dim> x = from + (static_cast<double>(k) / steps) * (to - from);
    if (passes_through<Dim>(before, x, distance(before), distance(x), halvings_of_step, distance)) return before;
    before = x;
  }
  return {};
}

}  // namespace

template <int Dim>
void KeepOutOfBodies<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<BodySet<Dim>> set,
                                      Read<StaticCut<Dim>> at_rest, Read<GridCells<Dim>> cells,
                                      Read<body::MiddlePosition<Dim>> c_middle,
                                      Read<body::MiddleRotation<Dim>> R_middle, Read<body::Position<Dim>> c_b,
                                      Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_b,
                                      Read<body::Spin<Dim>> omega_b, Read<particle::QuadraturePosition<Dim>> y_p,
                                      Update<particle::Position<Dim>> x_p, Update<particle::Velocity<Dim>> v_p,
                                      Update<Clamped> clamped) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const double least = gap * grid->spacing;
  const auto nearest_to = [&](const PlacedBodies<Dim>& at, const Vec<Dim>& x, double reach) {
    typename PlacedBodies<Dim>::Nearest nearest;
    if (at_rest->is_near(*grid, cell_of<Dim>(*grid, x))) nearest = at.nearest(x, false);
    if (!at.may_be_near(x, reach)) return nearest;
    const auto moving = at.nearest(x, true);
    return moving.distance < nearest.distance ? moving : nearest;
  };
  /// (E89)  v_p without the part that approaches a body at x_p.
  const auto stop_approach = [&](std::size_t p, std::size_t b, const Vec<Dim>& n) {
    const Vec<Dim> wall = rigid_velocity(V_b[b], omega_b[b], Vec<Dim>(x_p[p] - c_b[b]));
    const double approach = (v_p[p] - wall).dot(n);
    if (approach < 0) v_p[p] -= approach * n;
  };
  const PlacedBodies<Dim> in_middle(*set, c_middle.span(), R_middle.span());
  const auto stop_before_plate = [&](std::size_t p) {
    const auto nearest = nearest_to(in_middle, y_p[p], grid->spacing);
    if (nearest.body < 0 || nearest.distance <= 0) return false;
    const auto b = static_cast<std::size_t>(nearest.body);
    const Shape<Dim>& shape = *set->bodies[b].shape;
    const Vec<Dim> from = in_middle.placement(b).to_body(y_p[p]);
    const auto end = end_before_plate<Dim>(shape, from, bodies.placement(b).to_body(x_p[p]));
    if (!end) return false;
    x_p[p] = put_inside_box<Dim>(*grid, bodies.placement(b).to_world(*end)).x;
    stop_approach(p, b, bodies.placement(b).direction_to_world(shape.gradient(*end)).stableNormalized());
    return true;
  };
  // Or it would take the first half of the next step through the plate, which the grid does not see.
  const auto stop_at_plate = [&](std::size_t p, const typename PlacedBodies<Dim>::Nearest& nearest) {
    if (nearest.body < 0) return;
    const auto b = static_cast<std::size_t>(nearest.body);
    const Vec<Dim> wall = rigid_velocity(V_b[b], omega_b[b], Vec<Dim>(x_p[p] - c_b[b]));
    const Vec<Dim> ahead = 0.5 * clock->step * (v_p[p] - wall);
    if (ahead.norm() <= nearest.distance) return;
    const Shape<Dim>& shape = *set->bodies[b].shape;
    const Placement<Dim>& placement = bodies.placement(b);
    const Vec<Dim> from = placement.to_body(x_p[p]);
    if (!end_before_plate<Dim>(shape, from, from + placement.direction_to_body(ahead))) return;
    stop_approach(p, b, placement.direction_to_world(shape.gradient(from)).stableNormalized());
  };
  std::atomic<std::int64_t> count = 0;
  const auto keep_out = [&](std::size_t p) {
    bool was_inside = stop_before_plate(p);
    std::optional<Vec<Dim>> held_by;
    typename PlacedBodies<Dim>::Nearest nearest;
    for (int k = 0; k < most_tries; ++k) {
      nearest = nearest_to(bodies, x_p[p], least);
      if (nearest.distance >= least) break;
      const auto b = static_cast<std::size_t>(nearest.body);
      const Vec<Dim> gradient = bodies.placement(b).gradient(*set->bodies[b].shape, x_p[p]);
      const double steepness = gradient.norm();
      if (steepness == 0) break;
      const Vec<Dim> n = gradient / steepness;
      const Vec<Dim> away =
          x_p[p] + way_out<Dim>(n, (1.01 * least - nearest.distance) / steepness, held_by, grid->spacing);
      const Placed<Dim> placed = put_inside_box<Dim>(*grid, away);
      x_p[p] = placed.x;
      held_by = placed.clamped ? Vec<Dim>((placed.x - away).normalized()) : n;
      if (nearest.distance >= 0) continue;
      was_inside = true;
      stop_approach(p, b, n);
    }
    stop_at_plate(p, nearest);
    if (was_inside) ++count;
  };
  // Most cells are so far from bodies that no particle of them gets there within a step.
  const double within = grid->spacing;  // that no moving body is
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
}

template struct KeepOutOfBodies<2>;
template struct KeepOutOfBodies<3>;

}  // namespace minamo
