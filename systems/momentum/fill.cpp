#include "systems/momentum/fill.hpp"

#include "systems/grid/filled_nodes.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/grid/lanes.hpp"
#include "systems/grid/liquid_cells.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Fill fraction from which on a multiplier is an unknown. In 3-D more: foam at the surface would never settle.
template <int Dim>
constexpr double active_from = Dim == 2 ? 0.05 : 0.1;
/// The same under surface tension, which holds the surface together: pressure balances its force as far out as it acts.
constexpr double active_with_tension = 0.02;
/// And where pressure meets exact integrals over the liquid: it holds up what lies in a multiplier that has none.
constexpr double active_in_liquid = 1e-3;
/// Least mass of a face, as a share of that of a full grid: lighter ones only spoil the condition of S.
constexpr double least_mass = 1e-8;
/// |dt/2 grad v| up to which the second term of (E63) counts in full, and from which on not at all.
constexpr double resolved_to = 0.1;
constexpr double unresolved_from = 0.2;

/// dt/2 w f tr(grad v grad v), the divergence that a velocity without divergence now has half a step on, (E63).
template <int Dim>
double divergence_ahead(double half_step, double liquid, const Mat<Dim>& gradient) {
  const double strain = half_step * gradient.norm();
  const double resolved = std::clamp((unresolved_from - strain) / (unresolved_from - resolved_to), 0.0, 1.0);
  return resolved == 0 ? 0 : liquid * resolved * half_step * (gradient * gradient).trace();
}

template <int Dim>
double cell_volume(const Grid<Dim>& grid) {
  return Dim == 2 ? grid.spacing * grid.spacing : grid.spacing * grid.spacing * grid.spacing;
}

/// 1/mass, zero where a wall holds the face.
template <int Dim, class MassOf>
void invert_masses(double full_cell, const Splines<Dim>& splines, std::span<const Index<Dim>> site,
                   std::span<const std::uint8_t> held, std::span<Vec<Dim>> mobility, const MassOf& mass_of) {
  for_each_row(site.size(), [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      double& of_face = mobility[i][static_cast<Eigen::Index>(d)];
      of_face = 0;
      if ((held[i] & (1U << d)) != 0) continue;
      const double full = full_cell * splines.face_integral(site[i], d);
      of_face = 1 / std::max(mass_of(i, d, full), least_mass * full);
    }
  });
}

}  // namespace

template <int Dim>
void P2GMultipliers<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                     Read<GridCells<Dim>> cells, Read<CellSites> sites,
                                     Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                                     Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                                     Optional<Read<SiteExchange>> shared, Write<multiplier::Volume> v_l,
                                     Write<multiplier::DivergenceAhead> ahead_l) const {
  const auto gradient = grad_v_p.span();
  const double half_step = 0.5 * clock->step;
  const double full_cell = cell_volume<Dim>(*grid);
  for_each_row(v_l.size(), [&](std::size_t i) { v_l[i] = ahead_l[i] = 0; });
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      double filled = 0;
      for (std::size_t p = cell.begin; p < cell.end; ++p) filled += V_p[p];
      const double liquid = gradient.empty() ? 0 : liquid_indicator(filled / full_cell);
      std::array<Four, power(K, Dim)> volume{};
      std::array<Four, power(K, Dim)> ahead{};
      for_each_group(cell, [&](const Group& group) {
        const SplineWeights<Dim, K, Four> weights(frame, local<Dim>(frame, y_p.span(), group));
        const Four V = unused_are_zero(group, of_group(group, [&](std::size_t p) { return V_p[p]; }));
        Four divergence{};
        if (liquid > 0) {
          divergence =
              of_group(group, [&](std::size_t p) { return divergence_ahead<Dim>(half_step, liquid, gradient[p]); });
        }
        std::size_t m = 0;
        for_each_multiplier<Dim, K>([&](std::size_t, const Index<Dim>& offset) {
          const Four share = V * weights.multiplier(offset);
          volume[m] += share;
          ahead[m++] += share * divergence;
        });
      });
      const std::uint32_t* rows = sites->of(c);
      std::size_t m = 0;
      for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>&) {
        v_l[rows[k]] += sum_of_lanes(volume[m]);
        ahead_l[rows[k]] += sum_of_lanes(ahead[m++]);
      });
    });
  });
  add_up(shared, v_l.span());
  add_up(shared, ahead_l.span());
}

template <int Dim>
void FindFill<Dim>::operator()(Read<Splines<Dim>> splines, Read<staggered::Site<Dim>> site,
                               Read<staggered::Neighbour<Dim>> neighbour, Read<multiplier::Volume> v_l,
                               Read<multiplier::Capacity> capacity, Optional<Read<HiddenSites>> hidden,
                               Optional<Read<SiteExchange>> shared, Write<multiplier::FillFraction> phi,
                               Write<multiplier::FillAround> around, Write<multiplier::LeastFill> least) const {
  for_each_row(phi.size(), [&](std::size_t i) { phi[i] = capacity[i] > 0 ? v_l[i] / capacity[i] : 0; });
  // Of a neighbour that no particle touches, as if there were no bodies.
  const auto empty_room = [&](std::size_t i, std::size_t side) {
    const SplineAxis& along = splines->axis[side / 2];
    const int own = site[i][side / 2];
    const int adjacent = along.periodic() ? own : own + (side % 2 == 0 ? -1 : 1);
    return capacity[i] * along.width(adjacent) / along.width(own);
  };
  const auto neighbour_of = [&](std::size_t i, std::size_t side) {
    const std::int32_t j = neighbour[i][side];
    const bool is_there = j != staggered::none && !(hidden && hidden->has_faces_alone(static_cast<std::size_t>(j)));
    return is_there ? j : staggered::none;
  };
  for_each_row(phi.size(), [&](std::size_t i) {
    around[i] = phi[i];
    if (v_l[i] == 0) return;  // neighbours below may have no rows
    double filled = 2 * v_l[i];
    double room = 2 * capacity[i];
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const std::int32_t j = neighbour_of(i, side);
      filled += j == staggered::none ? 0 : v_l[static_cast<std::size_t>(j)];
      room += j == staggered::none ? empty_room(i, side) : capacity[static_cast<std::size_t>(j)];
    }
    if (filled > phi[i] * room) around[i] = filled / room;
  });
  // The least of neighbours is of neighbours of neighbours: farther than a rank knows volumes.
  if (shared) shared->copy_from_owner(around.span());
  for_each_row(phi.size(), [&](std::size_t i) {
    least[i] = around[i];
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      if (splines->ends_at(site[i], side)) continue;
      const std::int32_t j = neighbour[i][side];
      least[i] = std::min(least[i], j == staggered::none ? 0 : around[static_cast<std::size_t>(j)]);
    }
  });
}

template <int Dim>
void FindLiquidCellsByMultipliers<Dim>::operator()(Read<Splines<Dim>> splines, Read<GridCells<Dim>> cells,
                                                   Read<CellSites> sites, Read<multiplier::Volume> v_l,
                                                   Read<multiplier::Capacity> capacity,
                                                   Write<cell::LiquidIndicator> w_c,
                                                   Write<cell::BulkIndicator> b_c) const {
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto&) {
      const std::uint32_t* rows = sites->of(c);
      double volume = 0;
      double room = 0;
      for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>&) {
        volume += v_l[rows[k]];
        room += capacity[rows[k]];
      });
      const double fill_fraction = room > 0 ? volume / room : 0;
      w_c[c] = liquid_indicator(fill_fraction);
      b_c[c] = bulk_indicator(fill_fraction);
    });
  });
}

template <int Dim>
void FindMobility<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                                   Read<staggered::Site<Dim>> site, Read<face::Held> held, Read<face::Mass<Dim>> m_f,
                                   Optional<Read<face::UncutMass<Dim>>> uncut,
                                   Write<face::Mobility<Dim>> mobility) const {
  const auto of_particles = uncut ? uncut.span() : m_f.span();
  invert_masses<Dim>(
      fluid->density * cell_volume<Dim>(*grid), *splines, site.span(), held.span(), mobility.span(),
      [&](std::size_t i, std::size_t d, double) { return of_particles[i][static_cast<Eigen::Index>(d)]; });
}

template <int Dim>
void FindMobilityMixed<Dim>::operator()(Uses<MacGrid<Dim>> mac, Read<Fluid> fluid, Read<face::Held> held,
                                        Read<face::Mass<Dim>> m_f, Read<multiplier::LeastFill> least,
                                        Optional<Read<face::UncutMass<Dim>>> uncut,
                                        Optional<Read<face::Density<Dim>>> rho_f,
                                        Write<face::Mobility<Dim>> mobility) const {
  const auto of_particles = uncut ? uncut.span() : m_f.span();
  invert_masses<Dim>(fluid->density * cell_volume<Dim>(*mac.grid), *mac.splines, mac.site.span(), held.span(),
                     mobility.span(), [&](std::size_t i, std::size_t d, double full) {
                       const auto axis = static_cast<Eigen::Index>(d);
                       const double theta = filled_indicator(
                           least_fill_of_face<Dim>(*mac.splines, mac.site[i], mac.neighbour[i], least.span(), i, d));
                       const double whole = rho_f ? rho_f[i][axis] / fluid->density * full : full;
                       return (1 - theta) * of_particles[i][axis] + theta * whole;
                     });
}

template <int Dim>
void AssembleMultipliers<Dim>::operator()(
    Uses<MacGrid<Dim>> mac, Read<face::Mobility<Dim>> mobility, Read<multiplier::FillFraction> phi,
    Optional<Read<face::Open<Dim>>> open, Optional<Read<multiplier::Released>> released,
    Optional<Read<SurfaceTension>> tension, Optional<Read<multiplier::ContinuedFill>> continued,
    Optional<Read<multiplier::OpenShare>> open_share, Optional<Read<HiddenSites>> hidden, Resize<Unknowns> unknowns,
    Write<multiplier::Row> row, Write<unknown::Staggered> of_unknown, Write<unknown::Site<Dim>> unknown_site,
    Write<unknown::Neighbour<Dim>> unknown_neighbour, Write<unknown::Conductance<Dim>> conductance,
    Write<unknown::Diagonal> diagonal, Write<unknown::NullVector> null_vector) const {
  const Incidence<Dim> incidence(mac);
  const Passage<Dim> passage{open.span()};
  const auto conducts = [&](std::size_t f, std::size_t d) {
    const auto axis = static_cast<Eigen::Index>(d);
    return passage.share(f, axis) * mobility[f][axis];
  };
  const auto moves = [&](std::size_t i) {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (conducts(i, d) > 0 || conducts(incidence.above(i, d), d) > 0) return true;
    }
    return false;
  };
  const double from = tension ? active_with_tension : active_from<Dim>;
  const auto is_active = [&](std::size_t i) {
    if (hidden && hidden->is_hidden(i)) return false;
    if (!continued) return phi[i] > from;
    const bool is_cut_by_particles = open_share && open_share[i] < 1 && continued[i] == phi[i];
    return continued[i] > (is_cut_by_particles ? from : active_in_liquid);
  };
  std::int32_t count = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool is_released = released && released[i] != 0;
    row[i] = is_active(i) && !is_released && moves(i) ? count++ : staggered::none;
  }
  unknowns.resize(static_cast<std::size_t>(count));
  for_each_row(row.size(), [&](std::size_t i) {
    if (row[i] == staggered::none) return;
    const auto l = static_cast<std::size_t>(row[i]);
    of_unknown[l] = static_cast<std::uint32_t>(i);
    unknown_site[l] = mac.site[i];
    null_vector[l] = mac.splines->widths(mac.site[i]);
    for (std::size_t side = 0; side < 2 * Dim; ++side) {
      const std::int32_t j = mac.neighbour[i][side];
      unknown_neighbour[l][side] = j == staggered::none ? staggered::none : row[static_cast<std::size_t>(j)];
    }
    incidence.set_row(
        i, conducts, [&](std::size_t d) { return unknown_neighbour[l][2 * d + 1] != staggered::none; }, diagonal[l],
        conductance[l]);
  });
}

template struct P2GMultipliers<2>;
template struct P2GMultipliers<3>;
template struct FindFill<2>;
template struct FindFill<3>;
template struct FindLiquidCellsByMultipliers<2>;
template struct FindLiquidCellsByMultipliers<3>;
template struct FindMobility<2>;
template struct FindMobility<3>;
template struct FindMobilityMixed<2>;
template struct FindMobilityMixed<3>;
template struct AssembleMultipliers<2>;
template struct AssembleMultipliers<3>;

}  // namespace minamo
