#include "systems/bodies/divergence_ahead.hpp"

#include "systems/bodies/cut.hpp"
#include "systems/conforming/incidence.hpp"
#include "systems/conforming/polynomial.hpp"
#include "systems/grid/liquid_cells.hpp"

#include <cmath>

namespace minamo {

namespace {

/// |dt/2 grad v| that a gradient counts for at most: a step does not resolve more.
constexpr double largest_strain = 0.2;

/// The velocity of the nearest body around a point, zero where none moves.
template <int Dim>
struct WallMotion {
  const PlacedBodies<Dim>& bodies;
  bool any_moves;
  double reach;  ///< [m]
  std::span<const Vec<Dim>> pivot;
  std::span<const Vec<Dim>> velocity;
  std::span<const Vec<rotations<Dim>>> spin;

  struct Motion {
    Vec<Dim> velocity = Vec<Dim>::Zero();
    Vec<rotations<Dim>> spin = Vec<rotations<Dim>>::Zero();
  };
  Motion at(const Vec<Dim>& x) const {
    if (!any_moves || !bodies.may_be_near(x, reach)) return {};
    const auto moving = bodies.nearest(x, true);
    if (moving.body < 0 || bodies.distance(x, false) < moving.distance) return {};
    const auto b = static_cast<std::size_t>(moving.body);
    return {rigid_velocity(velocity[b], spin[b], x - pivot[b]), spin[b]};
  }
};

/// tr(G W), W v = omega x v.
double trace_with_spin(const Mat<2>& G, const Vec<1>& omega) { return omega[0] * (G(0, 1) - G(1, 0)); }
double trace_with_spin(const Mat<3>& G, const Vec<3>& omega) {
  return omega.dot(Vec<3>(G(1, 2) - G(2, 1), G(2, 0) - G(0, 2), G(0, 1) - G(1, 0)));
}

}  // namespace

template <int Dim>
void FindDivergenceAhead<Dim>::operator()(
    Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodySet<Dim>> set,
    Read<body::MiddlePosition<Dim>> c_b, Read<body::MiddleRotation<Dim>> R_b, Read<body::Velocity<Dim>> V_b,
    Read<body::Spin<Dim>> omega_b, Read<GridCells<Dim>> cells, Read<CellSites> sites,
    Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p, Read<particle::Volume> V_p,
    Read<particle::Velocity<Dim>> v_p, Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
    Read<staggered::Site<Dim>> site, Read<staggered::Neighbour<Dim>> neighbour, Read<face::Mass<Dim>> m_f,
    Read<face::Open<Dim>> open, Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi,
    Read<multiplier::Volume> v_l, Update<multiplier::Curvature> curvature) const {
  const auto gradient = grad_v_p.span();
  if (gradient.empty()) return;
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const WallMotion<Dim> walls{bodies, set->any_moves(), 3 * grid->spacing, c_b.span(), V_b.span(), omega_b.span()};
  const double half_step = 0.5 * clock->step;
  const Incidence<Dim> incidence(*grid, *splines, site.span(), neighbour.span());

  // Multipliers that bodies cut, and the rows of their faces.
  std::vector<std::uint8_t> is_cut(site.size(), 0);
  std::vector<std::uint8_t> has_face(site.size(), 0);
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (v_l[i] == 0 || share[i] == 0 || !splines->has_multiplier(site[i])) continue;
    bool cut = share[i] < 1;
    bool has_mass = true;
    for (std::size_t d = 0; d < Dim; ++d) {
      for (const std::size_t f : {i, incidence.above(i, d)}) {
        const auto axis = static_cast<Eigen::Index>(d);
        cut = cut || open[f][axis] < 1;
        has_mass = has_mass && (open[f][axis] == 0 || m_f[f][axis] > 0);
      }
    }
    if (!cut || !has_mass) continue;
    is_cut[i] = has_face[i] = 1;
    for (std::size_t d = 0; d < Dim; ++d) has_face[incidence.above(i, d)] = 1;
  }

  // dt/2 grad v (v - w) at faces, and what the spin of the wall adds at multipliers.
  std::vector<Vec<Dim>> turn(site.size(), Vec<Dim>::Zero());
  std::vector<double> of_spin(site.size(), 0.0);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const std::uint32_t* rows = sites->of(c);
      bool is_near = false;
      for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>&) { is_near = is_near || has_face[rows[k]] != 0; });
      if (!is_near) return;
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const SplineWeights<Dim, K> weights(frame, frame.local(y_p[p]));
        const double strain = half_step * gradient[p].norm();
        const Mat<Dim> G = half_step * std::min(1.0, largest_strain / strain) * gradient[p];
        const auto wall = walls.at(y_p[p]);
        const Vec<Dim> m_turn = m_p[p] * (G * (v_p[p] - wall.velocity));
        for_each_direction<Dim>([&](auto d) {
          constexpr int D = d();
          for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
            turn[rows[k]][D] += weights.template face<D>(offset) * m_turn[D];
          });
        });
        const double spins = V_p[p] * trace_with_spin(G, wall.spin);
        for_each_multiplier<Dim, K>(
            [&](std::size_t k, const Index<Dim>& offset) { of_spin[rows[k]] += weights.multiplier(offset) * spins; });
      }
    });
  });
  for_each_row(site.size(), [&](std::size_t i) {
    if (has_face[i] != 0) turn[i] = (m_f[i].array() > 0).select(turn[i].cwiseQuotient(m_f[i]), 0.0);
  });

  const Passage<Dim> passage{open.span(), {}};
  const double cell_volume = std::pow(grid->spacing, Dim);
  for_each_row(site.size(), [&](std::size_t i) {
    if (is_cut[i] == 0) return;
    const double of_walls = of_spin[i] / cell_volume;
    curvature[i] = v_l[i] * liquid_indicator(phi[i]) * (incidence.divergence(i, turn, passage) + of_walls);
  });
}

template struct FindDivergenceAhead<2>;
template struct FindDivergenceAhead<3>;

}  // namespace minamo
