#include "systems/bodies/motion/motion.hpp"

#include "components/grid.hpp"
#include "systems/shapes/rotation.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <stdexcept>
#include <tuple>

namespace minamo {

namespace {

template <int Dim>
struct Twist {
  Vec<Dim> velocity = Vec<Dim>::Zero();
  Vec<rotations<Dim>> spin = Vec<rotations<Dim>>::Zero();
};

template <int Dim>
Twist<Dim> twist_at(const Prescribed<Dim>& motion, double time) {
  Twist<Dim> twist;
  const std::array<double, 1> at{time};
  for (int d = 0; d < Dim; ++d) twist.velocity[d] = motion.velocity[static_cast<std::size_t>(d)](at);
  twist.spin = motion.rate(at) * motion.axis;
  return twist;
}

/// Linear between the rows of the table, the ends before and after.
template <int Dim>
std::pair<Vec<Dim>, double> place_at(const Tabulated<Dim>& motion, double time) {
  const auto after = std::upper_bound(motion.time.begin(), motion.time.end(), time);
  if (after == motion.time.begin()) return {motion.position.front(), motion.angle.front()};
  if (after == motion.time.end()) return {motion.position.back(), motion.angle.back()};
  const auto k = static_cast<std::size_t>(after - motion.time.begin());
  const double s = (time - motion.time[k - 1]) / (motion.time[k] - motion.time[k - 1]);
  return {motion.position[k - 1] + s * (motion.position[k] - motion.position[k - 1]),
          motion.angle[k - 1] + s * (motion.angle[k] - motion.angle[k - 1])};
}

/// Mean over [time, time + length].
template <int Dim>
Twist<Dim> mean_twist(const BodyScene<Dim>& body, double time, double length) {
  Twist<Dim> mean;
  if (const auto* prescribed = std::get_if<Prescribed<Dim>>(&body.motion)) {
    const Twist<Dim> a = twist_at<Dim>(*prescribed, time);
    const Twist<Dim> b = twist_at<Dim>(*prescribed, time + 0.5 * length);
    const Twist<Dim> c = twist_at<Dim>(*prescribed, time + length);
    mean.velocity = (a.velocity + 4 * b.velocity + c.velocity) / 6;
    mean.spin = (a.spin + 4 * b.spin + c.spin) / 6;
  } else if (const auto* table = std::get_if<Tabulated<Dim>>(&body.motion)) {
    const auto [from, angle_from] = place_at(*table, time);
    const auto [to, angle_to] = place_at(*table, time + length);
    mean.velocity = (to - from) / length;
    mean.spin[rotations<Dim> - 1] = (angle_to - angle_from) / length;
  }
  if (mean.velocity.allFinite() && mean.spin.allFinite()) return mean;
  // No shorter step gets past it.
  throw std::runtime_error(
      fmt::format("body \"{}\" has a velocity that is not finite in the step from t = {:.6g} s", body.name, time));
}

/// From a point to the farthest corner of a box. [m]
template <int Dim>
double farthest(const Vec<Dim>& from, const Vec<Dim>& low, const Vec<Dim>& high) {
  return (high - from).cwiseAbs().cwiseMax((from - low).cwiseAbs()).norm();
}

/// Of a body's points in the grid from the point that it turns about. A turn keeps distances, so that the shape's
/// bounds at the start tell. [m]
template <int Dim>
double reach(const BodyScene<Dim>& body, const Vec<Dim>& c_b, const Grid<Dim>& grid) {
  const double in_grid = farthest<Dim>(c_b, grid.low, grid.high);
  const Bounds<Dim> bounds = body.shape->bounds();
  return bounds.finite() ? std::min(in_grid, farthest<Dim>(body.pivot, bounds.low, bounds.high)) : in_grid;
}

}  // namespace

template <int Dim>
std::pair<Vec<Dim>, Vec<rotations<Dim>>> velocity_at(const BodyScene<Dim>& body, double time) {
  Twist<Dim> twist;
  if (const auto* prescribed = std::get_if<Prescribed<Dim>>(&body.motion)) {
    twist = twist_at<Dim>(*prescribed, time);
  } else if (const auto* free = body.free()) {
    twist = {free->velocity, free->spin};
  } else {
    constexpr double moment = 1e-6;
    twist = mean_twist<Dim>(body, time, moment);
  }
  return {twist.velocity, twist.spin};
}

template <int Dim>
double largest_speed_of_bodies(World& world, double ahead) {
  const double now = world.resource<Clock>().time;
  const auto& set = world.resource<BodySet<Dim>>();
  double largest = 0;
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const BodyScene<Dim>& body = set.bodies[b];
    if (!body.moves()) continue;
    const double r = reach<Dim>(body, world.column<body::Position<Dim>>()[b], world.resource<Grid<Dim>>());
    const auto look = [&](const Vec<Dim>& V, const Vec<rotations<Dim>>& omega) {
      largest = std::max(largest, V.norm() + r * omega.norm());
    };
    if (body.free() != nullptr) {
      look(world.column<body::Velocity<Dim>>()[b], world.column<body::Spin<Dim>>()[b]);
      continue;
    }
    for (const double share : {0.0, 0.5, 1.0}) {
      const auto [V, omega] = velocity_at<Dim>(body, now + share * ahead);
      look(V, omega);
    }
  }
  return largest;
}

template <int Dim>
void PlaceBodies<Dim>::operator()(Read<Clock> clock, Read<BodySet<Dim>> set, Read<body::Position<Dim>> c_b,
                                  Read<body::Rotation<Dim>> R_b, Read<body::Velocity<Dim>> V_old,
                                  Read<body::Spin<Dim>> omega_old, Read<body::Work> W_b,
                                  Write<body::MiddlePosition<Dim>> c_middle, Write<body::MiddleRotation<Dim>> R_middle,
                                  Write<body::MeanVelocity<Dim>> V_b, Write<body::MeanSpin<Dim>> omega_b,
                                  Write<body::OldWork> W_old) const {
  const double half = 0.5 * clock->step;
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    const BodyScene<Dim>& body = set->bodies[b];
    const Twist<Dim> mean =
        body.free() != nullptr ? Twist<Dim>{V_old[b], omega_old[b]} : mean_twist<Dim>(body, clock->time, clock->step);
    W_old[b] = W_b[b];
    V_b[b] = mean.velocity;
    omega_b[b] = mean.spin;
    c_middle[b] = c_b[b] + half * mean.velocity;
    R_middle[b] = rotation_by(Vec<rotations<Dim>>(half * mean.spin)) * R_b[b];
  }
}

template <int Dim>
void MoveBodies<Dim>::operator()(Read<Clock> clock, Read<BodySet<Dim>> set, Read<body::MeanVelocity<Dim>> V_mean,
                                 Read<body::MeanSpin<Dim>> omega_mean, Optional<Read<body::EndVelocity<Dim>>> V_end,
                                 Optional<Read<body::EndSpin<Dim>>> omega_end, Update<body::Position<Dim>> c_b,
                                 Update<body::Rotation<Dim>> R_b, Update<body::Angle<Dim>> alpha_b,
                                 Update<body::Velocity<Dim>> V_b, Update<body::Spin<Dim>> omega_b) const {
  const double dt = clock->step;
  for (std::size_t b = 0; b < set->bodies.size(); ++b) {
    c_b[b] += dt * V_mean[b];
    alpha_b[b] += dt * omega_mean[b];
    if (omega_mean[b].norm() > 0) R_b[b] = rotation_by(Vec<rotations<Dim>>(dt * omega_mean[b])) * R_b[b];
    if (set->bodies[b].free() != nullptr) {
      V_b[b] = V_end[b];
      omega_b[b] = omega_end[b];
    } else {
      std::tie(V_b[b], omega_b[b]) = velocity_at<Dim>(set->bodies[b], clock->time + dt);
    }
  }
}

template std::pair<Vec<2>, Vec<1>> velocity_at<2>(const BodyScene<2>&, double);
template std::pair<Vec<3>, Vec<3>> velocity_at<3>(const BodyScene<3>&, double);
template double largest_speed_of_bodies<2>(World&, double);
template double largest_speed_of_bodies<3>(World&, double);
template struct PlaceBodies<2>;
template struct PlaceBodies<3>;
template struct MoveBodies<2>;
template struct MoveBodies<3>;

}  // namespace minamo
