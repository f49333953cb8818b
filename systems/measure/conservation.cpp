#include "systems/measure/conservation.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/lanes.hpp"
#include "systems/time/body_force.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace minamo {

namespace {

/// Angular momentum in every lane.
template <int Dim>
using LaneRotation = std::array<Four, rotations<Dim>>;

/// x times v.
template <int Dim>
LaneRotation<Dim> cross(const LanePlace<Dim>& x, const LanePlace<Dim>& v) {
  const auto about = [&](std::size_t a, std::size_t b) { return x[a] * v[b] - x[b] * v[a]; };
  if constexpr (Dim == 3) {
    return {about(1, 2), about(2, 0), about(0, 1)};
  } else {
    return {about(0, 1)};
  }
}

/// sum_d D_dd e_d x dv/dx_d: what a velocity gradient adds to (x_I - x_p) x v on average over the support.
/// \param derivative  derivative(a, b) of component a of the velocity along b
template <int Dim, class Derivative>
LaneRotation<Dim> affine_spin(const LanePlace<Dim>& spread, const Derivative& derivative) {
  const auto about = [&](std::size_t a, std::size_t b) {
    return spread[a] * derivative(b, a) - spread[b] * derivative(a, b);
  };
  if constexpr (Dim == 3) {
    return {about(1, 2), about(2, 0), about(0, 1)};
  } else {
    return {about(0, 1)};
  }
}

/// The diagonal of D_p: h^2/4, and h^2 s (1 - s) at a distance s h < h/2 from a wall. [m^2]
template <int Dim>
LanePlace<Dim> support_spread(const Grid<Dim>& grid, const LanePlace<Dim>& x) {
  LanePlace<Dim> spread;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double to_wall = std::max(0.0, std::min(x[axis][lane] - grid.low[d], grid.high[d] - x[axis][lane]));
      const bool at_wall = !grid.periodic[axis] && to_wall < 0.5 * grid.spacing;
      spread[axis][lane] = at_wall ? to_wall * (grid.spacing - to_wall) : 0.25 * grid.spacing * grid.spacing;
    }
  }
  return spread;
}

/// The same of the faces of a direction, along the other axes. [m^2]
template <int Dim>
LanePlace<Dim> face_spread(const Grid<Dim>& grid, const Splines<Dim>& splines, const LanePlace<Dim>& x) {
  const double square = grid.spacing * grid.spacing;
  LanePlace<Dim> spread;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const SplineAxis& along = splines.axis[axis];
    const Four r = (x[axis] - grid.low[d]) / grid.spacing;
    const auto is_inner = [&](std::size_t lane) {
      return r[lane] >= along.inner_cells()[0] && r[lane] < along.inner_cells()[1];
    };
    if (is_inner(0) && is_inner(1) && is_inner(2) && is_inner(3)) {
      Four xi;
      for (std::size_t lane = 0; lane < lanes; ++lane) xi[lane] = r[lane] - static_cast<int>(r[lane]);
      spread[axis] = square * polynomial<3>(along.of_cell(static_cast<int>(r[0])).across_moment, xi);
      continue;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const AxisPlace at = axis_place(along, r[lane]);
      spread[axis][lane] = square * polynomial<3>(along.of_cell(at.cell).across_moment, at.xi);
    }
  }
  return spread;
}

double on_all(const Optional<Read<Ranks>>& ranks, double sum) { return ranks ? (*ranks)->sum(sum) : sum; }

template <int Size>
void add_up_on_all(const Optional<Read<Ranks>>& ranks, Vec<Size>& sum) {
  if (ranks) (*ranks)->sum(std::span(sum.data(), Size));
}

template <int Dim>
struct MassPoint {
  double mass = 0;
  Vec<Dim> first_moment = Vec<Dim>::Zero();
};

template <int Dim>
Vec<Dim> centre_of_mass(std::span<const double> m_p, std::span<const Vec<Dim>> x_p,
                        const Optional<Read<Ranks>>& ranks) {
  auto sum = reduce_rows(
      m_p.size(), MassPoint<Dim>{},
      [&](std::size_t p) {
        return MassPoint<Dim>{m_p[p], m_p[p] * x_p[p]};
      },
      [](const MassPoint<Dim>& a, const MassPoint<Dim>& b) {
        return MassPoint<Dim>{a.mass + b.mass, a.first_moment + b.first_moment};
      });
  sum.mass = on_all(ranks, sum.mass);
  add_up_on_all<Dim>(ranks, sum.first_moment);
  return sum.first_moment / sum.mass;
}

/// Not a function: a loop over particles would call it.
template <int Dim>
constexpr auto add = [](const measure::Momentum<Dim>& a, const measure::Momentum<Dim>& b) {
  return measure::Momentum<Dim>{a.linear + b.linear, a.angular + b.angular};
};

}  // namespace

template <int Dim>
double kinetic_energy(std::span<const double> m_p, std::span<const Vec<Dim>> v_p) {
  return reduce_rows(
      m_p.size(), 0.0, [&](std::size_t p) { return 0.5 * m_p[p] * v_p[p].squaredNorm(); }, std::plus<>());
}

template <int Dim>
void MeasureEnergy<Dim>::operator()(Read<Grid<Dim>> grid, Read<BodyForce> b, Read<particle::Mass> m_p,
                                    Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                    Optional<Read<Ranks>> ranks, Write<measure::Energy> energy) const {
  energy->kinetic = on_all(ranks, kinetic_energy<Dim>(m_p.span(), v_p.span()));
  energy->potential.reset();
  energy->surface.reset();
  energy->unresolved = 0;
  const auto force = force_with_potential<Dim>(*grid, *b);
  if (!force) return;
  energy->potential =
      on_all(ranks, reduce_rows(
                        m_p.size(), 0.0, [&](std::size_t p) { return -m_p[p] * force->dot(x_p[p] - grid->low); },
                        std::plus<>()));
}

template <int Dim>
void MeasureEnergyBalance<Dim>::operator()(Read<measure::Energy> energy, Optional<Read<body::Work>> W_b,
                                           Optional<Read<opening::EnergyIn>> E_o, Optional<Read<EnergyGiven>> given,
                                           Write<measure::EnergyBalance> balance,
                                           Update<measure::Columns> columns) const {
  *balance = {.value = energy->total(), .exchanged = 0};
  const auto give = [&](double joule) {
    balance->value -= joule;
    balance->exchanged += std::abs(joule);
  };
  for (const double work : W_b.span()) give(-work);
  for (const double came_in : E_o.span()) give(came_in);
  if (given) {
    give(given->value);
    give(given->by_forces);
  }
  if (W_b || E_o || given || energy->surface) columns->set("energy_balance", balance->value, Dim == 2 ? "J/m" : "J");
}

template <int Dim>
void MeasureMomentum<Dim>::operator()(Read<Grid<Dim>> grid, Optional<Read<Splines<Dim>>> splines,
                                      Read<particle::Mass> m_p, Read<particle::Position<Dim>> x_p,
                                      Read<particle::Velocity<Dim>> v_p,
                                      Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p,
                                      Optional<Read<Ranks>> ranks, Write<measure::Momentum<Dim>> momentum) const {
  const Vec<Dim> centre = centre_of_mass<Dim>(m_p.span(), x_p.span(), ranks);
  const auto gradient = grad_v_p.span();
  const auto spread_at = [&](const LanePlace<Dim>& x) {
    return splines ? face_spread<Dim>(*grid, *splines, x) : support_spread<Dim>(*grid, x);
  };
  const auto of_particles = [&](const Group& group) {
    const Four m = unused_are_zero(group, of_group(group, [&](std::size_t p) { return m_p[p]; }));
    LanePlace<Dim> x;
    LanePlace<Dim> arm;
    LanePlace<Dim> v;
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      x[axis] = of_group(group, [&](std::size_t p) { return x_p[p][d]; });
      v[axis] = of_group(group, [&](std::size_t p) { return v_p[p][d]; });
      arm[axis] = x[axis] - centre[d];
    }
    LaneRotation<Dim> spin = cross<Dim>(arm, v);
    if (!gradient.empty()) {
      const auto affine = affine_spin<Dim>(spread_at(x), [&](std::size_t a, std::size_t b) {
        return of_group(group, [&](std::size_t p) {
          return gradient[p](static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        });
      });
      for (std::size_t k = 0; k < spin.size(); ++k) spin[k] += affine[k];
    }
    measure::Momentum<Dim> sum;
    for (std::size_t d = 0; d < Dim; ++d) sum.linear[static_cast<Eigen::Index>(d)] = sum_of_lanes(m * v[d]);
    for (std::size_t k = 0; k < spin.size(); ++k) sum.angular[static_cast<Eigen::Index>(k)] = sum_of_lanes(m * spin[k]);
    return sum;
  };
  const std::size_t particles = m_p.size();
  *momentum = reduce_rows((particles + lanes - 1) / lanes, measure::Momentum<Dim>{},
                          [&](std::size_t group) {
                            const std::size_t first = lanes * group;
                            return of_particles({first, std::min(lanes, particles - first)});
                          },
                          add<Dim>);
  add_up_on_all<Dim>(ranks, momentum->linear);
  add_up_on_all<rotations<Dim>>(ranks, momentum->angular);
}

template <int Dim>
void MeasureMaxSpeed<Dim>::operator()(Read<particle::Velocity<Dim>> v_p, Optional<Read<Ranks>> ranks,
                                      Write<measure::MaxSpeed> speed) const {
  speed->value = std::sqrt(reduce_rows(
      v_p.size(), 0.0, [&](std::size_t p) { return v_p[p].squaredNorm(); },
      [](double x, double y) { return std::max(x, y); }));
  if (ranks) speed->value = (*ranks)->largest(speed->value);
}

template double kinetic_energy<2>(std::span<const double>, std::span<const Vec<2>>);
template double kinetic_energy<3>(std::span<const double>, std::span<const Vec<3>>);
template struct MeasureEnergy<2>;
template struct MeasureEnergy<3>;
template struct MeasureEnergyBalance<2>;
template struct MeasureEnergyBalance<3>;
template struct MeasureMomentum<2>;
template struct MeasureMomentum<3>;
template struct MeasureMaxSpeed<2>;
template struct MeasureMaxSpeed<3>;

}  // namespace minamo
