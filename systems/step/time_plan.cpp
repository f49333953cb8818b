#include "systems/step/time_plan.hpp"

#include "components/fluids.hpp"
#include "components/instant.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/bodies/motion/motion.hpp"
#include "systems/openings/opening_set.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/step/pipeline.hpp"
#include "systems/surface_tension/capillary_step.hpp"
#include "systems/time/body_force.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace minamo {

namespace {

/// Of particles, and of what comes in.
template <int Dim>
double largest_speed(World& world) {
  double squared = 0;
  for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) squared = std::max(squared, v.squaredNorm());
  const double inside = std::sqrt(squared);
  if (!world.has<OpeningSet<Dim>>()) return inside;
  return std::max(inside, largest_prescribed_speed<Dim>(world.resource<OpeningSet<Dim>>(), world.resource<Grid<Dim>>(),
                                                        world.resource<Splines<Dim>>(), world.resource<Clock>().time));
}

/// The largest |b_p|, now.
template <int Dim>
double largest_force(const BodyForce& force, World& world) {
  Instant now{.time = world.resource<Clock>().time, .ode = {}, .ode_count = 0};
  if (world.has<ode::Values>()) now = world.resource<ode::Values>();
  Arguments arguments(now);
  double squared = 0;
  const auto add = [&](const Vec<Dim>& x) {
    const double of_place = vector_at<Dim>(force.of_place_and_time, arguments.at<Dim>(x)).squaredNorm();
    if (!std::isfinite(of_place)) {
      throw std::runtime_error(
          fmt::format("time: no step can be chosen, body_force is not finite at ({:.6g}) m, t = {:.6g} s",
                      fmt::join(x.begin(), x.end(), ", "), now.time));
    }
    squared = std::max(squared, of_place);
  };
  // Liquid may come in where there is none.
  if (force.is_uniform()) {
    add(world.resource<Grid<Dim>>().low);
  } else {
    for (const Vec<Dim>& x : world.column<particle::Position<Dim>>()) add(x);
  }
  return std::sqrt(squared);
}

/// The positive root of (v + b dt) dt = distance, in the form that survives b = 0.
double crossing_time(double v, double b, double distance) {
  return 2 * distance / (v + std::sqrt(v * v + 4 * b * distance));
}

/// The step in which the fastest moving body crosses `cfl` cells, if that is shorter than dt. A velocity that is not
/// finite ends the run where bodies are placed, with its name.
double step_of_bodies(const Scene& scene, World& world, double dt) {
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  if (!bodies || !(bodies->in_plane.any_moves() || bodies->in_space.any_moves())) return dt;
  const double w = scene.dimension == 2 ? largest_speed_of_bodies<2>(world, dt) : largest_speed_of_bodies<3>(world, dt);
  return std::isfinite(w) && w * dt > scene.time.cfl * scene.grid.spacing ? scene.time.cfl * scene.grid.spacing / w
                                                                          : dt;
}

/// Kinematic viscosity of the thinnest liquid. [m^2/s]
double least_viscosity(const Scene& scene) {
  const auto of = [](const Fluid& fluid) { return fluid.viscosity / fluid.density; };
  const auto* several = scene.facts.find<Fluids>();
  if (several == nullptr || several->of.empty()) return of(scene.facts.get<Fluid>());
  double least = of(several->of.front());
  for (const Fluid& fluid : several->of) least = std::min(least, of(fluid));
  return least;
}

/// (E34)  Longest step over sqrt(h/|b|); 0: any.
double share_of_fall(const Scene& scene, double largest_speed, double largest_force) {
  constexpr double newmark = 0.125;
  constexpr double midpoint = 1.0 / 3;
  if (scene.schemes.at("integrator") == "newmark") return newmark;
  if (!is_conforming(scene)) return midpoint;
  if (scene.schemes.at("quadrature") != "exact") return 0;
  constexpr double at_rest = 1.0 / 6;
  // Waves of two cells, k = pi/h, that viscosity damps within sqrt(1/(|b| k)): nu k^2 >= sqrt(|b| k).
  const double h = scene.grid.spacing;
  const double overdamped = h * std::sqrt(largest_force * h) / std::pow(std::numbers::pi, 1.5);
  if (least_viscosity(scene) >= overdamped) return 0;
  if (scene.facts.find<BodiesOfScene>() != nullptr) return at_rest;
  // Froude number of the fastest from which on the liquid is no longer near rest; twice that, and it moves.
  constexpr double near_rest = 0.5;
  const double froude = largest_speed / std::sqrt(largest_force * h);
  return at_rest * std::clamp(froude / near_rest, 1.0, 2.0);
}

}  // namespace

std::optional<double> gravity_step(const Scene& scene, double largest_speed, double largest_force) {
  if (!(largest_force > 0)) return {};
  const double share = share_of_fall(scene, largest_speed, largest_force);
  if (share == 0) return {};
  return share * std::sqrt(scene.grid.spacing / largest_force);
}

std::vector<std::string> warnings_of_gravity(const Scene& scene) {
  constexpr double much_longer = 2;  // what grows within some thousand steps
  const auto longest = gravity_step(scene, 0, size_of_constant_force(scene.facts.get<BodyForce>()));
  if (!longest || !scene.time.step || *scene.time.step <= much_longer * *longest) return {};
  return {
      fmt::format("a step of {:.3g} s is more than twice as long as the body force allows, {:.3g} s: waves grow in a "
                  "liquid at rest",
                  *scene.time.step, *longest)};
}

double step_of_cfl(const Scene& scene, double largest_speed, double largest_force) {
  const double dt = crossing_time(largest_speed, largest_force, scene.time.cfl * scene.grid.spacing);
  return std::min({dt, scene.time.max_step.value_or(dt), scene.output.every, capillary_step(scene).value_or(dt),
                   gravity_step(scene, largest_speed, largest_force).value_or(dt)});
}

double step_from_rest(const Scene& scene) {
  if (scene.time.step) return *scene.time.step;
  return step_of_cfl(scene, 0, size_of_constant_force(scene.facts.get<BodyForce>()));
}

TimePlan make_time_plan(const Scene& scene) {
  TimePlan plan{.end = scene.time.end,
                .step = scene.time.step,
                .choose_step = {},
                .frame_every = scene.output.every,
                .checkpoint_every = scene.output.checkpoint,
                .max_steps = {},
                .record_every = scene.output.history,
                .unrecorded = make_pipeline(scene).unrecorded};
  if (plan.step) return plan;
  plan.choose_step = [scene](World& world) {
    const double v = scene.dimension == 2 ? largest_speed<2>(world) : largest_speed<3>(world);
    const auto& force = scene.facts.get<BodyForce>();
    const double b = scene.dimension == 2 ? largest_force<2>(force, world) : largest_force<3>(force, world);
    return step_of_bodies(scene, world, step_of_cfl(scene, largest_over_ranks(v), largest_over_ranks(b)));
  };
  return plan;
}

}  // namespace minamo
