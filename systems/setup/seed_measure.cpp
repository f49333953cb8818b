#include "systems/setup/seed_measure.hpp"

#include "components/exact.hpp"
#include "components/measure.hpp"
#include "components/particle.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

constexpr std::string_view axes = "xyz";

void seed_ode(const Scene& scene, const std::string& file, World& world, std::vector<Problem>& problems) {
  const Instant start = start_of(scene);
  auto& equations = world.resource<ode::Equations>();
  static_cast<Instant&>(world.resource<ode::Values>()) = start;
  std::vector<double> arguments{0};
  arguments.insert(arguments.end(), start.ode.begin(),
                   start.ode.begin() + static_cast<std::ptrdiff_t>(start.ode_count));
  for (const OdeScene& variable : scene.ode) {
    equations.name.push_back(variable.name);
    equations.rate.push_back(variable.rate);
    const double rate = variable.rate(arguments);
    if (std::isfinite(rate)) continue;
    problems.push_back({file, fmt::format("/ode/{}/rate", variable.name), "not finite", "a finite rate at the start",
                        fmt::format("{} at t = 0", rate), ""});
  }
}

/// The first particle where an exact field is not finite.
template <int Dim>
void check_exact(const std::string& pointer, const Expression& field, const Scene& scene, const std::string& file,
                 World& world, std::vector<Problem>& problems) {
  Arguments arguments(start_of(scene));
  for (const Vec<Dim>& x : world.column<particle::Position<Dim>>()) {
    const double value = field(arguments.at<Dim>(x));
    if (std::isfinite(value)) continue;
    std::string place;
    for (int d = 0; d < Dim; ++d) place += fmt::format("{} = {:.6g}, ", axes[static_cast<std::size_t>(d)], x[d]);
    problems.push_back({file, pointer, "not finite", "a finite value at every particle",
                        fmt::format("{} at {}t = 0", value, place), ""});
    return;
  }
}

template <int Dim>
void seed_exact(const Scene& scene, const std::string& file, World& world, std::vector<Problem>& problems) {
  if (!scene.exact.velocity.empty()) {
    world.resource<exact::Velocity>().of_part.fill(scene.exact.velocity);
    world.resource<exact::Velocity>().until = scene.exact.until;
  }
  for (std::size_t d = 0; d < scene.exact.velocity.size(); ++d) {
    check_exact<Dim>(fmt::format("/exact/velocity/{}", d), scene.exact.velocity[d], scene, file, world, problems);
  }
  if (!scene.exact.pressure) return;
  world.resource<exact::Pressure>() = {std::vector(exact::parts, *scene.exact.pressure), scene.exact.pressure_is_free,
                                       scene.exact.until};
  check_exact<Dim>("/exact/pressure", *scene.exact.pressure, scene, file, world, problems);
}

template <int Dim>
void seed_probes(const Scene& scene, World& world) {
  for (const ProbeScene& probe : scene.probes) {
    typename measure::Probes<Dim>::Probe seeded;
    seeded.pressure = probe.name + "_pressure";
    for (std::size_t d = 0; d < Dim; ++d) {
      seeded.at[static_cast<Eigen::Index>(d)] = probe.at[d];
      seeded.velocity[d] = fmt::format("{}_velocity_{}", probe.name, axes[d]);
    }
    world.resource<measure::Probes<Dim>>().probes.push_back(std::move(seeded));
  }
}

}  // namespace

Instant start_of(const Scene& scene) {
  Instant start;
  start.ode_count = scene.ode.size();
  for (std::size_t k = 0; k < scene.ode.size(); ++k) start.ode[k] = scene.ode[k].start;
  return start;
}

template <int Dim>
void seed_measure(const Scene& scene, const std::string& file, World& world, std::vector<Problem>& problems) {
  if (!scene.ode.empty()) seed_ode(scene, file, world, problems);
  seed_exact<Dim>(scene, file, world, problems);
  seed_probes<Dim>(scene, world);
}

template void seed_measure<2>(const Scene&, const std::string&, World&, std::vector<Problem>&);
template void seed_measure<3>(const Scene&, const std::string&, World&, std::vector<Problem>&);

}  // namespace minamo
