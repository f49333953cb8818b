#include "systems/bodies/keep_out.hpp"

#include "systems/setup/lattice.hpp"
#include "systems/transfer/advect.hpp"

#include <atomic>
#include <cmath>

namespace minamo {

namespace {

/// Distance that particles keep from bodies, in units of h.
constexpr double gap = 1e-3;
constexpr int most_tries = 4;

}  // namespace

template <int Dim>
void KeepOutOfBodies<Dim>::operator()(Read<Grid<Dim>> grid, Read<BodySet<Dim>> set, Read<StaticCut<Dim>> at_rest,
                                      Read<body::Position<Dim>> c_b, Read<body::Rotation<Dim>> R_b,
                                      Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b,
                                      Update<particle::Position<Dim>> x_p, Update<particle::Velocity<Dim>> v_p,
                                      Update<Clamped> clamped) const {
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const double least = gap * grid->spacing;
  std::atomic<std::int64_t> count = 0;
  const auto keep_out = [&](std::size_t p, bool moving) {
    bool was_inside = false;
    for (int k = 0; k < most_tries; ++k) {
      const auto nearest = bodies.nearest(x_p[p], moving);
      if (nearest.distance >= least) break;
      const auto b = static_cast<std::size_t>(nearest.body);
      const Vec<Dim> normal = bodies.placement(b).gradient(*set->bodies[b].shape, x_p[p]);
      const double square = normal.squaredNorm();
      if (square == 0) break;
      x_p[p] += (1.01 * least - nearest.distance) / square * normal;
      if (nearest.distance >= 0) continue;
      was_inside = true;
      const Vec<Dim> n = normal / std::sqrt(square);
      const Vec<Dim> wall = rigid_velocity(V_b[b], omega_b[b], Vec<Dim>(x_p[p] - c_b[b]));
      const double approach = (v_p[p] - wall).dot(n);
      if (approach < 0) v_p[p] -= approach * n;
    }
    x_p[p] = put_inside_box<Dim>(*grid, x_p[p]).x;
    if (was_inside) ++count;
  };
  const bool rests = !at_rest->of.empty();
  for_each_row(x_p.size(), [&](std::size_t p) {
    if (rests && at_rest->near[row_in<Dim>(grid->cells, cell_of<Dim>(*grid, x_p[p]))] != 0) keep_out(p, false);
    if (bodies.may_be_near(x_p[p], least)) keep_out(p, true);
  });
  clamped->count += count;
}

template struct KeepOutOfBodies<2>;
template struct KeepOutOfBodies<3>;

}  // namespace minamo
