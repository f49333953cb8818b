#include "systems/setup/time_plan.hpp"

#include "components/instant.hpp"
#include "components/particle.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

template <int Dim>
double largest_speed(World& world) {
  double squared = 0;
  for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) squared = std::max(squared, v.squaredNorm());
  return std::sqrt(squared);
}

/// |b| in the middle of the box, now.
template <int Dim>
double force(const Scene& scene, World& world) {
  Instant now{.time = world.resource<Clock>().time, .ode = {}, .ode_count = 0};
  if (!scene.ode.empty()) now = world.resource<ode::Values>();
  Vec<Dim> middle;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    middle[d] = 0.5 * (scene.grid.low[axis] + scene.grid.high[axis]);
  }
  Arguments arguments(now);
  return vector_at<Dim>(scene.body_force, arguments.at<Dim>(middle)).norm();
}

/// The positive root of (v + b dt) dt = distance, in the form that survives b = 0.
double crossing_time(double v, double b, double distance) {
  return 2 * distance / (v + std::sqrt(v * v + 4 * b * distance));
}

}  // namespace

TimePlan make_time_plan(const Scene& scene) {
  TimePlan plan{.end = scene.time.end,
                .step = scene.time.step,
                .choose_step = {},
                .frame_every = scene.output.every,
                .checkpoint_every = scene.output.checkpoint,
                .max_steps = {}};
  if (plan.step) return plan;
  plan.choose_step = [scene](World& world) {
    const double v = scene.dimension == 2 ? largest_speed<2>(world) : largest_speed<3>(world);
    const double b = scene.dimension == 2 ? force<2>(scene, world) : force<3>(scene, world);
    const double dt = crossing_time(v, b, scene.time.cfl * scene.grid.spacing);
    return std::min({dt, scene.time.max_step.value_or(dt), scene.output.every});
  };
  return plan;
}

}  // namespace minamo
