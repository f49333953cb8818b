#include "systems/openings/particles.hpp"

#include "systems/openings/columns.hpp"
#include "systems/time/body_force.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// How far inside a particle has to be at the end of a step that lets it in: where a column moves by whole spacings,
/// rounding does not choose. [a]
constexpr double well_in = 1e-9;

/// What the potential energy is of; zero where there is none.
template <int Dim>
Vec<Dim> constant_force(const Grid<Dim>& grid, const BodyForce& b) {
  return force_with_potential<Dim>(grid, b).value_or(Vec<Dim>::Zero());
}

template <int Dim>
double energy_of(double mass, const Vec<Dim>& from_low, const Vec<Dim>& v, const Vec<Dim>& force) {
  return mass * (0.5 * v.squaredNorm() - force.dot(from_low));
}

/// A particle that comes in.
template <int Dim>
struct Arrival {
  std::size_t opening;
  Vec<Dim> x;
  double size;
  typename Side<Dim>::Jet velocity;
};

/// Mean over an opening of the velocity along its side: how fast its columns drift. [m/s]
template <int Dim>
Vec<Dim> drift_speed(const Opening<Dim>& opening, const Side<Dim>& side, const opening::SideVelocity<Dim>& w) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  double area = 0;
  for (std::size_t k = 0; k < opening.share.size(); ++k) {
    if (opening.share[k] == 0) continue;
    const Index<Dim> site = side.site(k, side.axis());
    const double weight = opening.share[k] * side.area(site);
    const Vec<Dim> v = side.at(w, side.place(site, side.axis())).value;
    area += weight;
    sum += weight * v;
  }
  if (area > 0) sum /= area;
  sum[static_cast<Eigen::Index>(side.axis())] = 0;
  return sum;
}

template <int Dim>
class Emission {
 public:
  Emission(const Clock& clock, const Grid<Dim>& grid, const Splines<Dim>& splines, const OpeningSet<Dim>& set,
           double density)
      : clock_(clock), grid_(grid), splines_(splines), set_(set), density_(density) {}

  /// Moves the columns of an opening that prescribes its velocity by a step.
  void prescribe(std::size_t o, std::span<double> front, Vec<Dim>& drift) {
    const Opening<Dim>& opening = set_.openings[o];
    const Side<Dim> side(grid_, splines_, opening.side);
    const auto axis = static_cast<Eigen::Index>(side.axis());
    const auto w_start = prescribed_velocity<Dim>(opening, set_, grid_, splines_, clock_.time);
    const auto w = prescribed_velocity<Dim>(opening, set_, grid_, splines_,
                                            clock_.time + 0.5 * (clock_.end_of_step - clock_.time));
    const Columns<Dim> columns(opening, grid_);
    const Vec<Dim> along = clock_.step * drift_speed<Dim>(opening, side, w);
    const double a = columns.spacing();
    const auto moved = [&](const Vec<Dim>& x) {
      return side.inward() * clock_.step * side.at(w, side.within(x + 0.5 * along)).value[axis];
    };
    columns.for_each_that_may_come(drift, along, side.plane(), [&](std::size_t k, const Vec<Dim>& x) {
      const double across = moved(x);
      for (double depth = front[k]; depth + across > well_in * a; depth -= a) {
        if (!columns.is_on_side(x + (-depth / across) * along, set_, splines_, o, along)) continue;
        Arrival<Dim> arrival{o, x, a, side.at(w_start, side.within(x))};
        arrival.x[axis] += side.inward() * depth;
        arrivals_.push_back(arrival);
      }
    });
    for (std::size_t k = 0; k < front.size(); ++k) {
      front[k] += moved(columns.place(k, drift, side.plane()));
      while (front[k] > well_in * a) front[k] -= a;
      while (front[k] <= (well_in - 1) * a) front[k] += a;
    }
    drift += along;
    columns.renumber(drift, front);
  }
  /// Foresees what comes in through an opening with a pressure outside, with the speeds of the last step.
  void foresee(std::size_t o, std::span<const double> front, std::span<const double> speed) {
    const Opening<Dim>& opening = set_.openings[o];
    const Side<Dim> side(grid_, splines_, opening.side);
    const auto axis = static_cast<Eigen::Index>(side.axis());
    const Columns<Dim> columns(opening, grid_);
    for (std::size_t k = 0; k < front.size(); ++k) {
      if (speed[k] <= 0) continue;
      const Vec<Dim> x = columns.place(k, Vec<Dim>::Zero(), side.plane());
      if (!columns.is_on_side(x, set_, splines_, o, Vec<Dim>::Zero()) ||
          pressure_outside<Dim>(opening, set_, density_, x, clock_.time) <= 0)
        continue;
      const double a = columns.spacing();
      for (double depth = front[k]; depth + clock_.step * speed[k] > well_in * a; depth -= a) {
        Arrival<Dim> arrival{o, x, a, {Vec<Dim>::Zero(), Mat<Dim>::Zero()}};
        arrival.x[axis] += side.inward() * depth;
        arrival.velocity.value[axis] = side.inward() * speed[k];
        arrival.velocity.gradient.row(axis) = side.inward() * columns.slope(speed, k).transpose();
        arrivals_.push_back(arrival);
      }
    }
  }
  const std::vector<Arrival<Dim>>& arrivals() const { return arrivals_; }

 private:
  const Clock& clock_;
  const Grid<Dim>& grid_;
  const Splines<Dim>& splines_;
  const OpeningSet<Dim>& set_;
  double density_;
  std::vector<Arrival<Dim>> arrivals_;
};

}  // namespace

template <int Dim>
void LetIn<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                            Read<BodyForce> b, Read<OpeningSet<Dim>> set, Optional<Read<Ranks>> ranks,
                            Optional<Read<RankMap>> map, Resize<Particles> particles, Update<particle::Id> id,
                            Update<particle::Mass> m_p, Update<particle::Volume> V_p,
                            Update<particle::Position<Dim>> x_p, Update<particle::Velocity<Dim>> v_p,
                            Write<opening::Arrivals<Dim>> arrivals, Update<opening::Front> front,
                            Read<opening::Speed> speed, Update<opening::Drift<Dim>> drift,
                            Update<opening::NextId> next_id, Update<opening::MassIn> mass_in,
                            Update<opening::EnergyIn> energy_in) const {
  Emission<Dim> emission(*clock, *grid, *splines, *set, fluid->density);
  for_each_opening<Dim>(*set, *grid, [&](std::size_t o, std::size_t first, std::size_t count) {
    if (set->openings[o].is_prescribed()) {
      emission.prescribe(o, front.span().subspan(first, count), drift[o]);
    } else if (count > 0) {
      emission.foresee(o, front.span().subspan(first, count), speed.span().subspan(first, count));
    }
  });
  const std::size_t before = particles.rows();
  arrivals->first_row = before;
  arrivals->velocity_gradient.clear();
  const auto comes_here = [&](const Arrival<Dim>& arrival) {
    return !ranks || rank_at<Dim>(*map, *grid, *splines, arrival.x) == (*ranks)->rank();
  };
  const auto here = std::count_if(emission.arrivals().begin(), emission.arrivals().end(), comes_here);
  if (here > 0) particles.resize(before + static_cast<std::size_t>(here));
  const Vec<Dim> force = constant_force<Dim>(*grid, *b);
  std::size_t p = before;
  for (const Arrival<Dim>& arrival : emission.arrivals()) {
    const double volume = std::pow(arrival.size, Dim);
    const double mass = fluid->density * volume;
    mass_in[arrival.opening] += mass;
    energy_in[arrival.opening] += energy_of<Dim>(mass, arrival.x - grid->low, arrival.velocity.value, force);
    const std::int64_t own_id = next_id->value++;
    if (!comes_here(arrival)) continue;
    id[p] = own_id;
    V_p[p] = volume;
    m_p[p] = mass;
    x_p[p] = arrival.x;
    v_p[p] = arrival.velocity.value;
    arrivals->velocity_gradient.push_back(arrival.velocity.gradient);
    ++p;
  }
}

template <int Dim>
void GiveGradient<Dim>::operator()(Read<opening::Arrivals<Dim>> arrivals,
                                   Update<particle::VelocityGradient<Dim>> grad_v_p) const {
  for (std::size_t k = 0; k < arrivals->velocity_gradient.size(); ++k)
    grad_v_p[arrivals->first_row + k] = arrivals->velocity_gradient[k];
}

template <int Dim>
void MoveColumns<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                  Read<Fluid> fluid, Read<OpeningSet<Dim>> set,
                                  Read<opening::Velocities<Dim>> velocities, Update<opening::Front> front,
                                  Update<opening::Speed> speed) const {
  for_each_opening<Dim>(*set, *grid, [&](std::size_t o, std::size_t first, std::size_t count) {
    const Opening<Dim>& opening = set->openings[o];
    if (!opening.has_pressure()) return;
    const Side<Dim> side(*grid, *splines, opening.side);
    const auto axis = static_cast<Eigen::Index>(side.axis());
    const Columns<Dim> columns(opening, *grid);
    const double a = columns.spacing();
    for (std::size_t k = first; k < first + count; ++k) {
      const Vec<Dim> x = columns.place(k - first, Vec<Dim>::Zero(), side.plane());
      const bool is_wet = columns.is_on_side(x, *set, *splines, o, Vec<Dim>::Zero()) &&
                          pressure_outside<Dim>(opening, *set, fluid->density, x, clock->time) > 0;
      const double now = is_wet ? side.inward() * side.at(velocities->in_balances[o], side.within(x)).value[axis] : 0;
      const double moved = clock->step * now;
      // What was foreseen has come in as far as the column has moved.
      double depth = front[k];
      while (speed[k] > 0 && depth + std::min(clock->step * speed[k], moved) > well_in * a) depth -= a;
      front[k] = depth + moved;
      while (front[k] <= (well_in - 1) * a) front[k] += a;
      speed[k] = now;
    }
  });
}

template <int Dim>
void LetOut<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<BodyForce> b,
                             Read<OpeningSet<Dim>> set, Optional<Read<Ranks>> ranks, Resize<Particles> particles,
                             Read<particle::Mass> m_p, Read<particle::Position<Dim>> x_p,
                             Read<particle::Velocity<Dim>> v_p, Update<opening::MassIn> mass_in,
                             Update<opening::EnergyIn> energy_in) const {
  const Vec<Dim> force = constant_force<Dim>(*grid, *b);
  std::vector<std::optional<std::uint32_t>> stay;
  stay.reserve(x_p.size());
  std::vector<std::array<double, 2>> out(set->openings.size(), {0, 0});  // mass, energy
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const int through = set->left_through(*grid, *splines, x_p[p]);
    if (through == no_opening) {
      stay.emplace_back(static_cast<std::uint32_t>(p));
      continue;
    }
    auto& [mass, energy] = out[static_cast<std::size_t>(through)];
    mass += m_p[p];
    energy += energy_of<Dim>(m_p[p], x_p[p] - grid->low, v_p[p], force);
  }
  if (ranks) (*ranks)->sum({out.front().data(), 2 * out.size()});
  for (std::size_t o = 0; o < out.size(); ++o) {
    mass_in[o] -= out[o][0];
    energy_in[o] -= out[o][1];
  }
  if (stay.size() < x_p.size()) particles.renumber(stay);
}

template struct LetIn<2>;
template struct LetIn<3>;
template struct GiveGradient<2>;
template struct GiveGradient<3>;
template struct MoveColumns<2>;
template struct MoveColumns<3>;
template struct LetOut<2>;
template struct LetOut<3>;

}  // namespace minamo
