#include "systems/bodies/coupling/divergence_ahead.hpp"

#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/grid/liquid_cells.hpp"
#include "systems/transfer/face_scatter.hpp"

#include <algorithm>
#include <vector>

namespace minamo {

namespace {

/// |dt/2 grad v| that a gradient counts for at most: a step does not resolve more.
constexpr double largest_turn = 0.2;

/// How the nearest body moves; not at all where none does.
template <int Dim>
struct WallMotion {
  const PlacedBodies<Dim>& bodies;
  bool any_moves;
  double reach;  ///< [m]
  std::span<const Vec<Dim>> pivot;
  std::span<const Vec<Dim>> velocity;
  std::span<const Vec<rotations<Dim>>> spin;

  struct Motion {
    Vec<Dim> there = Vec<Dim>::Zero();     ///< velocity at the point [m/s]
    Vec<Dim> of_pivot = Vec<Dim>::Zero();  ///< [m/s]
    Vec<rotations<Dim>> spin = Vec<rotations<Dim>>::Zero();
  };
  Motion at(const Vec<Dim>& x) const {
    if (!any_moves || !bodies.may_be_near(x, reach)) return {};
    const auto moving = bodies.nearest(x, true);
    if (moving.body < 0 || bodies.distance(x, false) < moving.distance) return {};
    const auto b = static_cast<std::size_t>(moving.body);
    return {rigid_velocity(velocity[b], spin[b], x - pivot[b]), velocity[b], spin[b]};
  }
};

/// How much a velocity that turns at a rate counts. \param turn  dt/2 times the rate
double counted_share(double turn) { return std::min(1.0, largest_turn / turn); }

/// Multipliers that bodies cut, and the sites of their faces.
struct CutMultipliers {
  std::vector<std::uint8_t> is_cut;
  std::vector<std::uint8_t> has_face;
};

template <int Dim>
CutMultipliers find_cut(const Incidence<Dim>& incidence, const Splines<Dim>& splines, std::span<const Index<Dim>> site,
                        std::span<const Vec<Dim>> m_f, std::span<const Vec<Dim>> open, std::span<const double> share,
                        std::span<const double> v_l) {
  CutMultipliers cut{std::vector<std::uint8_t>(site.size(), 0), std::vector<std::uint8_t>(site.size(), 0)};
  for (std::size_t i = 0; i < site.size(); ++i) {
    if (!(v_l[i] > 0) || share[i] == 0 || !splines.has_multiplier(site[i])) continue;  // not of a site known in part
    bool is_cut = share[i] < 1;
    bool has_mass = true;  // without, no particle tells how the liquid turns
    for (std::size_t d = 0; d < Dim; ++d) {
      for (const std::size_t f : {i, incidence.above(i, d)}) {
        const auto axis = static_cast<Eigen::Index>(d);
        is_cut = is_cut || open[f][axis] < 1;
        has_mass = has_mass && (open[f][axis] == 0 || m_f[f][axis] > 0);
      }
    }
    if (!is_cut || !has_mass) continue;
    cut.is_cut[i] = cut.has_face[i] = 1;
    for (std::size_t d = 0; d < Dim; ++d) cut.has_face[incidence.above(i, d)] = 1;
  }
  return cut;
}

}  // namespace

template <int Dim>
void FindDivergenceAhead<Dim>::operator()(
    Read<Clock> clock, Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement, Read<body::Velocity<Dim>> V_b,
    Read<body::Spin<Dim>> omega_b, Read<GridCells<Dim>> cells, Read<CellSites> sites,
    Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Mass> m_p, Read<particle::Velocity<Dim>> v_p,
    Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p, Read<face::Mass<Dim>> m_f, Read<face::Open<Dim>> open,
    Read<multiplier::OpenShare> share, Read<multiplier::FillFraction> phi, Read<multiplier::Volume> v_l,
    Optional<Read<SiteExchange>> shared, Update<multiplier::DivergenceAhead> ahead_l) const {
  const auto gradient = grad_v_p.span();
  if (!grad_v_p) return;
  const PlacedBodies<Dim> bodies(placement);
  const WallMotion<Dim> walls{
      bodies, placement.set->any_moves(), 3 * mac.grid->spacing, placement.c_b.span(), V_b.span(), omega_b.span()};
  const double half_step = 0.5 * clock->step;
  const Incidence<Dim> incidence(mac);

  const CutMultipliers cut =
      find_cut<Dim>(incidence, *mac.splines, mac.site.span(), m_f.span(), open.span(), share.span(), v_l.span());

  std::vector<Vec<Dim>> turn(mac.site.size(), Vec<Dim>::Zero());
  with_degree(mac.splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const std::uint32_t* rows = sites->of(c);
      bool is_near = false;
      for_each_site<Dim, K>([&](std::size_t k, const Index<Dim>&) { is_near = is_near || cut.has_face[rows[k]] != 0; });
      if (!is_near) return;
      const CellFrame<Dim> frame(*mac.grid, *mac.splines, cell.node);
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const SplineWeights<Dim, K> weights(frame, frame.local(y_p[p]));
        const auto wall = walls.at(y_p[p]);
        const Vec<Dim> by_liquid =
            counted_share(half_step * gradient[p].norm()) * (gradient[p] * (v_p[p] - wall.there));
        const Vec<Dim> by_wall =
            counted_share(half_step * wall.spin.norm()) *
            rigid_velocity(Vec<Dim>(Vec<Dim>::Zero()), wall.spin, Vec<Dim>(v_p[p] - wall.of_pivot));
        const Vec<Dim> m_turn = m_p[p] * half_step * (by_liquid + by_wall);
        for_each_direction<Dim>([&](auto d) {
          constexpr int D = d();
          for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
            turn[rows[k]][D] += weights.template face<D>(offset) * m_turn[D];
          });
        });
      }
    });
  });
  add_up(shared, std::span(turn));
  divide_by_mass<Dim>(m_f.span(), turn);

  const Passage<Dim> passage{open.span(), {}};
  for_each_costly_row(mac.site.size(), [&](std::size_t i) {
    if (cut.is_cut[i] == 0) return;
    ahead_l[i] = v_l[i] * liquid_indicator(phi[i]) * incidence.divergence(i, turn, passage);
  });
}

template struct FindDivergenceAhead<2>;
template struct FindDivergenceAhead<3>;

}  // namespace minamo
