#include "systems/openings/faces.hpp"

#include "engine/run/step_control.hpp"
#include "systems/bodies/particles/room.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/time/body_force.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

/// The velocities that all openings prescribe at a time; empty of those that do not.
template <int Dim>
std::vector<opening::SideVelocity<Dim>> prescribed_velocities(const OpeningSet<Dim>& set, const Grid<Dim>& grid,
                                                              const Splines<Dim>& splines, double time) {
  std::vector<opening::SideVelocity<Dim>> velocities;
  for (const Opening<Dim>& opening : set.openings) {
    velocities.push_back(opening.is_prescribed() ? prescribed_velocity<Dim>(opening, set, grid, splines, time)
                                                 : opening::SideVelocity<Dim>{});
  }
  return velocities;
}

/// Calls set_face(row, d, velocity) for the faces that openings hold.
template <int Dim, class SetFace>
void hold_faces_at(const std::vector<opening::SideVelocity<Dim>>& velocities, const OpeningSet<Dim>& set,
                   const Grid<Dim>& grid, const Splines<Dim>& splines, const Walls<Dim>& walls,
                   std::span<const Index<Dim>> site, const SetFace& set_face) {
  for_each_prescribed<Dim>(set, grid, splines, walls, site, [&](std::size_t i, std::size_t d, std::size_t o) {
    const Side<Dim> side(grid, splines, set.openings[o].side);
    set_face(i, static_cast<Eigen::Index>(d), velocities[o].of[d][side.index(site[i], d)]);
  });
}

/// What faces with rows have on a side, across it what passes them; zero elsewhere. All ranks have all of it.
template <int Dim>
opening::SideVelocity<Dim> velocity_on(const Side<Dim>& side, const Splines<Dim>& splines, const Passage<Dim>& passage,
                                       std::span<const Index<Dim>> site, std::span<const Vec<Dim>> v_f,
                                       const SiteExchange* shared) {
  opening::SideVelocity<Dim> velocity;
  for (std::size_t d = 0; d < Dim; ++d) {
    std::vector<double>& of = velocity.of[d];
    of.assign(side.count(d), 0);
    for_each_row(site.size(), [&](std::size_t i) {
      if (!side.holds(site[i], d) || !splines.has_face(site[i], d) || !owns(shared, i)) return;
      const auto axis = static_cast<Eigen::Index>(d);
      of[side.index(site[i], d)] = (d == side.axis() ? passage.share(i, axis) : 1) * v_f[i][axis];
    });
    add_up_on_all(shared, std::span(of));
  }
  return velocity;
}

/// Points and weights of Gauss's rule with two points: exact for polynomials up to the third degree.
constexpr std::array<double, 2> gauss_place{0.21132486540518712, 0.78867513459481288};

/// Parts of a cell, 0 ... 1, on both sides of a cut.
std::vector<std::array<double, 2>> parts_of_cell(double cut) {
  if (cut <= 0 || cut >= 1) return {{0, 1}};
  return {{0, cut}, {cut, 1}};
}

/// What the splines of faces across of an opening integrate to over its side, times the pressure outside and where
/// there is any.
struct Outside {
  std::vector<double> pressure;  ///< [N]
  std::vector<double> wet;       ///< [m^2; m in 2-D]
};

template <int Dim>
Outside integrate_outside(const Opening<Dim>& opening, const OpeningSet<Dim>& set, const Grid<Dim>& grid,
                          const Splines<Dim>& splines, double density, double time) {
  const Side<Dim> side(grid, splines, opening.side);
  Outside outside{std::vector<double>(side.count(side.axis()), 0), std::vector<double>(side.count(side.axis()), 0)};
  Index<Dim> cell{};
  // A level cuts the cells that it passes.
  const auto cut_of = [&](std::size_t e) {
    if (opening.kind != OpeningKind::level || set.vertical->axis != e) return 0.0;
    const auto axis = static_cast<Eigen::Index>(e);
    const double level = (*opening.level)(std::array{0.0, 0.0, 0.0, time});
    return (level - grid.low[axis]) / grid.spacing - cell[e];
  };
  const auto add = [&](const Vec<Dim>& x, double weight) {
    const double p = pressure_outside<Dim>(opening, set, density, x, time);
    require_finite_opening(opening.name, "pressure", p, time);
    if (p == 0) return;
    side.for_each_across(x, [&](std::size_t k, double spline) {
      outside.pressure[k] += weight * spline * p;
      outside.wet[k] += weight * spline;
    });
  };
  const std::function<void(std::size_t, Vec<Dim>, double)> along = [&](std::size_t e, Vec<Dim> x, double weight) {
    if (e == Dim) return add(x, weight);
    const auto axis = static_cast<Eigen::Index>(e);
    if (e == side.axis()) {
      x[axis] = side.plane();
      return along(e + 1, x, weight);
    }
    for (const auto& part : parts_of_cell(cut_of(e))) {
      for (const double place : gauss_place) {
        const double width = part[1] - part[0];
        x[axis] = grid.low[axis] + grid.spacing * (cell[e] + part[0] + place * width);
        along(e + 1, x, weight * 0.5 * width * grid.spacing);
      }
    }
  };
  for (;;) {
    along(0, Vec<Dim>::Zero(), 1);
    std::size_t e = 0;
    while (e < Dim && (e == side.axis() || ++cell[e] == grid.cells[e])) cell[e++] = 0;
    if (e == Dim) return outside;
  }
}

/// How full the grid is next to an opening, compared to what is under the level outside, from which on it bears all of
/// the pressure. Gaps between particles are no reason for less: it would drive a flow.
constexpr double full_from = 0.5;

/// Weights of a point along an axis on the multipliers of its cell, with what a lattice that ends at an open side
/// misses.
template <int K>
struct EndWeights {
  std::array<double, K> plain{};
  std::array<double, K> ended{};
};

/// From 0 to 1 within rounding of zero: of particles that a lattice has on a side and a spacing away, one counts for
/// the other, whatever rounding says about each. \param s  distance [a]
double past(double s) {
  constexpr double rounding = 1e-9;
  return std::clamp((s + rounding) / (2 * rounding), 0.0, 1.0);
}

/// \param splines  of the cell along the axis
/// \param xi       place in the cell
/// \param s        distance from the open side, less than zero outside [a]
template <int K>
EndWeights<K> end_weights(const CellSplines& splines, double xi, const std::array<std::optional<double>, 2>& s) {
  EndWeights<K> weights;
  for (std::size_t a = 0; a < K; ++a) weights.plain[a] = polynomial<K - 1>(splines.across[a], xi);
  weights.ended = weights.plain;
  for (const std::size_t end : {0, 1}) {
    if (!s[end]) continue;
    const double is_in = past(*s[end]);
    for (double& weight : weights.ended) weight *= is_in;
    weights.ended[end == 0 ? 0 : K - 1] += (is_in - past(*s[end] - 1)) * (*s[end] - 0.5);
  }
  return weights;
}

}  // namespace

template <int Dim>
void OpenFaces<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls,
                                Read<OpeningSet<Dim>> set, Read<staggered::Site<Dim>> site,
                                Update<face::Held> held) const {
  for_each_row(held.size(), [&](std::size_t i) {
    unsigned mask = 0;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (condition_at<Dim>(*set, *grid, *splines, *walls, site[i], d).is_held) mask |= 1U << d;
    }
    held[i] = static_cast<std::uint8_t>(mask);
  });
}

template <int Dim>
void HoldInflow<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                 Read<Walls<Dim>> walls, Read<OpeningSet<Dim>> set, Read<staggered::Site<Dim>> site,
                                 Update<face::Velocity<Dim>> v_f) const {
  hold_faces_at<Dim>(prescribed_velocities<Dim>(*set, *grid, *splines, clock->time), *set, *grid, *splines, *walls,
                     site.span(), [&](std::size_t i, Eigen::Index d, double w) { v_f[i][d] = w; });
}

template <int Dim>
void PrescribeInflow<Dim>::operator()(Read<Clock> clock, Read<Rates> rates, Read<Grid<Dim>> grid,
                                      Read<Splines<Dim>> splines, Read<Walls<Dim>> walls, Read<OpeningSet<Dim>> set,
                                      Read<staggered::Site<Dim>> site, Write<opening::Velocities<Dim>> velocities,
                                      Write<face::Prescribed<Dim>> w_f) const {
  velocities->in_balances = prescribed_velocities<Dim>(*set, *grid, *splines, rates->time);
  velocities->at_end = prescribed_velocities<Dim>(*set, *grid, *splines, clock->end_of_step);
  for_each_row(w_f.size(), [&](std::size_t i) { w_f[i].setZero(); });
  hold_faces_at<Dim>(velocities->in_balances, *set, *grid, *splines, *walls, site.span(),
                     [&](std::size_t i, Eigen::Index d, double w) { w_f[i][d] = w; });
}

template <int Dim>
void PassInflow<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Walls<Dim>> walls,
                                 Read<OpeningSet<Dim>> set, Read<staggered::Site<Dim>> site,
                                 Read<face::Closed<Dim>> closed, Update<face::Open<Dim>> open) const {
  for_each_prescribed<Dim>(
      *set, *grid, *splines, *walls, site.span(), [&](std::size_t i, std::size_t d, std::size_t o) {
        if (d != set->openings[o].side / 2) return;
        const auto [by_resting, by_moving] = closed[i][d];
        open[i][static_cast<Eigen::Index>(d)] = by_moving == 0 ? 1 : 1 - by_moving / (1 - by_resting);
      });
}

template <int Dim>
void FillAtOpenings<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                     Read<OpeningSet<Dim>> set, Read<GridCells<Dim>> cells, Read<CellSites> sites,
                                     Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                     Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                                     Optional<Read<SiteExchange>> shared, Update<multiplier::Volume> v_l,
                                     Update<multiplier::DivergenceAhead> ahead_l) const {
  const std::vector<double> plain_volume(v_l.begin(), v_l.end());
  // Ranks add up what each of them changes.
  for (std::size_t i = 0; shared && i < v_l.size(); ++i) {
    if (!shared->owns(i)) v_l[i] = 0;
  }
  const auto is_adjacent = [&](const Index<Dim>& cell, std::size_t side) {
    return set->opens(side) && cell[side / 2] == (side % 2 == 0 ? 0 : grid->cells[side / 2] - 1);
  };
  // y_p is kept inside the box; how far outside a particle is tells where it would be.
  const auto distance = [&](std::size_t p, std::size_t side) {
    const Side<Dim> of(*grid, *splines, side);
    const auto axis = static_cast<Eigen::Index>(of.axis());
    const double inside = of.inward() * (y_p[p][axis] - of.plane());
    if (inside > 2 * off_wall * grid->spacing) return inside;
    return of.inward() * (x_p[p][axis] + 0.5 * clock->step * v_p[p][axis] - of.plane());
  };
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      bool is_at_end = false;
      for (std::size_t side = 0; side < 2 * Dim; ++side) is_at_end = is_at_end || is_adjacent(cell.node, side);
      if (!is_at_end) return;
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      const std::uint32_t* rows = sites->of(c);
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const Vec<Dim> xi = frame.local(y_p[p]);
        const double size = std::pow(V_p[p], 1.0 / Dim);
        std::array<EndWeights<K>, static_cast<std::size_t>(Dim)> weights;
        for (std::size_t e = 0; e < Dim; ++e) {
          std::array<std::optional<double>, 2> s;
          for (const std::size_t end : {0, 1}) {
            const std::size_t side = 2 * e + end;
            if (is_adjacent(cell.node, side) && set->at(*grid, *splines, side, y_p[p]) != no_opening)
              s[end] = distance(p, side) / size;
          }
          weights[e] = end_weights<K>(*frame.splines[e], xi[static_cast<Eigen::Index>(e)], s);
        }
        for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
          double plain = V_p[p];
          double ended = V_p[p];
          for (std::size_t e = 0; e < Dim; ++e) {
            plain *= weights[e].plain[static_cast<std::size_t>(offset[e])];
            ended *= weights[e].ended[static_cast<std::size_t>(offset[e])];
          }
          v_l[rows[k]] += ended - plain;
        });
      }
    });
  });
  add_up(shared, v_l.span());
  for_each_row(v_l.size(), [&](std::size_t i) {
    if (v_l[i] == plain_volume[i]) return;
    // Where all particles are outside, rounding is left, and nothing must be divided by it.
    constexpr double rounding = 1e-10;
    if (v_l[i] < rounding * plain_volume[i]) v_l[i] = 0;
    ahead_l[i] *= v_l[i] / plain_volume[i];
  });
}

template <int Dim>
void PushAtOpenings<Dim>::operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<Fluid> fluid,
                                     Read<OpeningSet<Dim>> set, Read<multiplier::FillFraction> phi,
                                     Read<face::Velocity<Dim>> v_f, Read<face::Mobility<Dim>> mobility,
                                     Write<face::OutsideForce<Dim>> F_f, Update<face::Predictor<Dim>> predictor) const {
  for_each_row(F_f.size(), [&](std::size_t i) { F_f[i].setZero(); });
  const double tau = rates->velocity / rates->acceleration;
  for (std::size_t o = 0; o < set->openings.size(); ++o) {
    const Opening<Dim>& opening = set->openings[o];
    if (!opening.has_pressure()) continue;
    const Side<Dim> side(*mac.grid, *mac.splines, opening.side);
    const std::size_t d = side.axis();
    const auto axis = static_cast<Eigen::Index>(d);
    const Outside outside = integrate_outside<Dim>(opening, *set, *mac.grid, *mac.splines, fluid->density, rates->time);
    for_each_row(mac.site.size(), [&](std::size_t i) {
      if (mobility[i][axis] == 0 || !side.holds(mac.site[i], d)) return;
      const std::size_t k = side.index(mac.site[i], d);
      if (set->of_face[opening.side][k] != static_cast<std::int16_t>(o) || outside.pressure[k] == 0) return;
      const std::int32_t l =
          mac.splines->has_multiplier(mac.site[i]) ? static_cast<std::int32_t>(i) : mac.neighbour[i][2 * d];
      if (l == staggered::none) return;
      const double filled = phi[static_cast<std::size_t>(l)] * side.area(mac.site[i]);
      const double share = std::min(1.0, filled / (full_from * outside.wet[k]));
      const double inwards = opening.is_static ? 0 : std::max(0.0, side.inward() * v_f[i][axis]);
      const double head = 0.5 * fluid->density * inwards * inwards * outside.wet[k];
      F_f[i][axis] = side.inward() * share * (outside.pressure[k] - head);
      predictor[i][axis] += tau * mobility[i][axis] * F_f[i][axis];
    });
  }
}

template <int Dim>
void TakeOpeningVelocities<Dim>::operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<Walls<Dim>> walls,
                                            Read<OpeningSet<Dim>> set, Read<BodyForce> b, Read<face::Mass<Dim>> m_f,
                                            Read<face::OutsideForce<Dim>> F_f, Read<face::Velocity<Dim>> v_old,
                                            Read<face::BalanceVelocity<Dim>> v_f, Read<face::NewVelocity<Dim>> v_new,
                                            Read<multiplier::Force> lambda, Optional<Read<face::Open<Dim>>> open,
                                            Optional<Read<SiteExchange>> shared,
                                            Update<opening::Velocities<Dim>> velocities,
                                            Update<opening::EnergyIn> energy, Write<opening::StepWork> work) const {
  const Incidence<Dim> incidence(mac);
  const Passage<Dim> passage{open.span()};
  const auto at = [&](std::size_t l) { return lambda[l]; };
  for (std::size_t o = 0; o < set->openings.size(); ++o) {
    if (set->openings[o].is_prescribed()) continue;
    const Side<Dim> side(*mac.grid, *mac.splines, set->openings[o].side);
    velocities->in_balances[o] =
        velocity_on<Dim>(side, *mac.splines, passage, mac.site.span(), v_f.span(), of_ranks(shared));
    velocities->at_end[o] =
        velocity_on<Dim>(side, *mac.splines, passage, mac.site.span(), v_new.span(), of_ranks(shared));
  }
  std::vector<double> done(set->openings.size() + 1, 0);  // on liquid in every opening; the last one: all work
  const Vec<Dim> force = force_with_potential<Dim>(*mac.grid, *b).value_or(Vec<Dim>::Zero());
  // One after the other: the same sums on any number of threads.
  for (std::size_t i = 0; i < mac.site.size(); ++i) {
    if (!owns(of_ranks(shared), i)) continue;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      const FaceCondition condition = condition_at<Dim>(*set, *mac.grid, *mac.splines, *walls, mac.site[i], d);
      if (condition.opening == no_opening) continue;
      const auto o = static_cast<std::size_t>(condition.opening);
      const double share = passage.share(i, axis);
      double impulse = clock->step * share * F_f[i][axis];
      if (condition.is_held) {
        impulse = m_f[i][axis] * (v_new[i][axis] - v_old[i][axis]) - clock->step * share * incidence.gradient(i, d, at);
      }
      done.back() += impulse * v_f[i][axis];
      // The body force does work on what an opening carries up or down, which counts with the potential of particles.
      if (condition.is_held) impulse -= clock->step * m_f[i][axis] * force[axis];
      done[o] += impulse * v_f[i][axis];
    }
  }
  add_up_on_all(of_ranks(shared), std::span(done));
  work->value = done.back();
  for (std::size_t o = 0; o < set->openings.size(); ++o) energy[o] += done[o];
}

template <int Dim>
void RequireOutlet<Dim>::operator()(Read<Clock> clock, Uses<MacGrid<Dim>> mac, Read<face::Prescribed<Dim>> w_f,
                                    Read<multiplier::Volume> v_l, Read<multiplier::Capacity> capacity,
                                    Read<unknown::Staggered> of_unknown, Read<unknown::NullVector> n_l,
                                    Read<MultiplierSolver<Dim>> solver) const {
  constexpr double least_squeeze = 1e-9;
  const ClosedComponents& components = solver->closed();
  const std::vector<bool> is_full = full_components(components, of_unknown.span(), v_l.span(), capacity.span());
  const Incidence<Dim> incidence(mac);
  std::vector<std::array<double, 2>> sums(components.count(), {0, 0});
  for (std::size_t l = 0; l < of_unknown.size() && !sums.empty(); ++l) {
    if (!components.counts(l) || !is_full[components.number(l) - 1]) continue;
    auto& [squeeze, room] = sums[components.number(l) - 1];
    squeeze -= n_l[l] * incidence.divergence(of_unknown[l], w_f.span());
    room += n_l[l];
  }
  components.add_up({reinterpret_cast<double*>(sums.data()), 2 * sums.size()});
  for (const auto& [squeeze, room] : sums) {
    if (room == 0 || std::abs(squeeze) * clock->step <= least_squeeze * room) continue;
    throw StepRejected(
        fmt::format("openings: {:.3g} m^{}/s come in where walls enclose the liquid all around, without a way out",
                    squeeze * std::pow(mac.grid->spacing, Dim), Dim));
  }
}

template struct OpenFaces<2>;
template struct OpenFaces<3>;
template struct HoldInflow<2>;
template struct HoldInflow<3>;
template struct PrescribeInflow<2>;
template struct PrescribeInflow<3>;
template struct PassInflow<2>;
template struct PassInflow<3>;
template struct FillAtOpenings<2>;
template struct FillAtOpenings<3>;
template struct PushAtOpenings<2>;
template struct PushAtOpenings<3>;
template struct TakeOpeningVelocities<2>;
template struct TakeOpeningVelocities<3>;
template struct RequireOutlet<2>;
template struct RequireOutlet<3>;

}  // namespace minamo
