#include "systems/measure/conservation.hpp"

#include "engine/schedule/parallel.hpp"
#include "systems/grid/site_support.hpp"
#include "systems/time/body_force.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <functional>

namespace minamo {

namespace {

template <int Dim>
using Rotation = Vec<rotations<Dim>>;

/// x times v.
template <int Dim>
Rotation<Dim> cross(const Vec<Dim>& x, const Vec<Dim>& v) {
  if constexpr (Dim == 3) {
    return x.cross(v);
  } else {
    return Rotation<2>(x[0] * v[1] - x[1] * v[0]);
  }
}

/// sum_d D_dd e_d x dv/dx_d: what a velocity gradient adds to (x_I - x_p) x v on average over the support.
template <int Dim>
Rotation<Dim> affine_spin(const Vec<Dim>& spread, const Mat<Dim>& grad_v) {
  const auto about = [&](int a, int b) { return spread[a] * grad_v(b, a) - spread[b] * grad_v(a, b); };
  if constexpr (Dim == 3) {
    return {about(1, 2), about(2, 0), about(0, 1)};
  } else {
    return Rotation<2>(about(0, 1));
  }
}

/// The diagonal of D_p: h^2/4, and h^2 s (1 - s) at a distance s h < h/2 from a wall. [m^2]
template <int Dim>
Vec<Dim> support_spread(const Grid<Dim>& grid, const Vec<Dim>& x) {
  Vec<Dim> spread;
  for (int d = 0; d < Dim; ++d) {
    const double to_wall = std::max(0.0, std::min(x[d] - grid.low[d], grid.high[d] - x[d]));
    const bool at_wall = !grid.periodic[static_cast<std::size_t>(d)] && to_wall < 0.5 * grid.spacing;
    spread[d] = at_wall ? to_wall * (grid.spacing - to_wall) : 0.25 * grid.spacing * grid.spacing;
  }
  return spread;
}

/// The same of the faces of a direction, along the other axes. [m^2]
template <int Dim>
Vec<Dim> face_spread(const Grid<Dim>& grid, const Splines<Dim>& splines, const Vec<Dim>& x) {
  Vec<Dim> spread;
  for (int d = 0; d < Dim; ++d) {
    const SplineAxis& axis = splines.axis[static_cast<std::size_t>(d)];
    const AxisPlace at = axis_place(axis, (x[d] - grid.low[d]) / grid.spacing);
    spread[d] = grid.spacing * grid.spacing * polynomial<3>(axis.of_cell(at.cell).across_moment, at.xi);
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
  const auto spread_at = [&](const Vec<Dim>& x) {
    return splines ? face_spread<Dim>(*grid, *splines, x) : support_spread<Dim>(*grid, x);
  };
  *momentum = reduce_rows(
      m_p.size(), measure::Momentum<Dim>{},
      [&](std::size_t p) {
        Rotation<Dim> spin = cross<Dim>(x_p[p] - centre, v_p[p]);
        if (!gradient.empty()) spin += affine_spin<Dim>(spread_at(x_p[p]), gradient[p]);
        return measure::Momentum<Dim>{m_p[p] * v_p[p], m_p[p] * spin};
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
