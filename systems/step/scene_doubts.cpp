#include "systems/step/scene_doubts.hpp"

#include "components/fluid.hpp"
#include "components/fluids.hpp"
#include "components/particle.hpp"
#include "components/surface_tension.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/openings/openings_part.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

double norm_of(const std::vector<double>& vector) {
  double squared = 0;
  for (const double component : vector) squared += component * component;
  return std::sqrt(squared);
}

/// Extent of the box along a direction. [m]
double extent_along(const GridScene& grid, const std::vector<double>& direction) {
  double sum = 0;
  for (std::size_t d = 0; d < direction.size(); ++d) sum += std::abs(direction[d]) * (grid.high[d] - grid.low[d]);
  return sum / norm_of(direction);
}

double smallest_extent(const GridScene& grid) {
  double smallest = grid.high[0] - grid.low[0];
  for (std::size_t d = 1; d < grid.low.size(); ++d) smallest = std::min(smallest, grid.high[d] - grid.low[d]);
  return smallest;
}

void doubt_of_fall(const Scene& scene, std::vector<std::string>& doubts) {
  const std::vector<double> force = scene.facts.get<BodyForce>().constant_components();
  const double b = norm_of(force);
  constexpr double of_gravity = 1;  // [m/s^2] weaker forces may well drive a slow flow through a large box
  constexpr double large = 50;      // [m] along the force
  if (!(b >= of_gravity)) return;
  const double height = extent_along(scene.grid, force);
  const double time = std::sqrt(height / b);
  if (height < large || scene.time.end >= time) return;
  doubts.push_back(
      fmt::format("in {:.4g} s a body force of {:.4g} m/s^2 hardly moves what is as large as the box, {:.4g} m "
                  "along the force, which takes {:.3g} s: lengths are in metres, not in millimetres",
                  scene.time.end, b, height, time));
}

void doubt_of_gravity(const Scene& scene, std::vector<std::string>& doubts) {
  const double b = norm_of(scene.facts.get<BodyForce>().constant_components());
  for (const auto& [unit, factor] : {std::pair("mm", 1e3), std::pair("cm", 1e2)}) {
    constexpr double least = 9.7, most = 9.9;  // between the equator and the poles, however it is rounded [m/s^2]
    if (b >= least * factor && b <= most * factor)
      doubts.push_back(fmt::format("a body force of {:.6g} m/s^2 looks like gravity in {}/s^2", b, unit));
  }
}

void doubt_of_tension(const Scene& scene, std::vector<std::string>& doubts) {
  const auto* tension = scene.facts.find<SurfaceTension>();
  const auto* fluid = scene.facts.find<Fluid>();
  if (tension == nullptr || fluid == nullptr || tension->coefficient == 0) return;
  constexpr double large = 0.5;        // [m]
  constexpr double hardly_any = 1e-3;  // of a swing; a splash in a tank of a metre has a twentieth of one
  const double extent = smallest_extent(scene.grid);
  const double time = std::sqrt(fluid->density * std::pow(extent, 3) / tension->coefficient);
  if (extent < large || scene.time.end >= hardly_any * time) return;
  doubts.push_back(fmt::format("in {:.4g} s a surface tension of {:.4g} N/m does not move what is as large as the box, "
                               "{:.4g} m, which takes {:.3g} s: lengths are in metres, not in millimetres",
                               scene.time.end, tension->coefficient, extent, time));
}

constexpr double speed_of_sound = 1500;  // in water [m/s]

void doubt_of_speed(const std::string& what, double speed, std::vector<std::string>& doubts) {
  if (!(speed > speed_of_sound)) return;
  doubts.push_back(fmt::format("{} at {:.4g} m/s, faster than sound in water, {} m/s, which no incompressible flow is",
                               what, speed, speed_of_sound));
}

constexpr int instants_seen =
    11;  // at which what is given by expressions is looked at, the start and the end among them

double instant_of_run(const Scene& scene, int k) { return scene.time.end * k / (instants_seen - 1); }

/// Of the point that it turns about. [m/s]
template <int Dim>
double largest_speed_of(const BodyScene<Dim>& body, const Scene& scene) {
  if (const auto* free = body.free()) return free->velocity.norm();
  const auto* prescribed = std::get_if<Prescribed<Dim>>(&body.motion);
  if (prescribed == nullptr) return 0;
  double largest = 0;
  for (int k = 0; k < instants_seen; ++k) {
    const std::array<double, 1> t{instant_of_run(scene, k)};
    std::vector<double> velocity;
    for (const Expression& v : prescribed->velocity) velocity.push_back(v.is_constant() ? v({}) : v(t));
    largest = std::max(largest, norm_of(velocity));
  }
  return largest;
}

/// Along the diagonal of its side. [m/s]
template <int Dim>
double largest_speed_of(const Opening<Dim>& opening, const Scene& scene) {
  constexpr int places = 11;
  double largest = 0;
  for (int k = 0; k < instants_seen && !opening.velocity.empty(); ++k) {
    Arguments arguments({.time = instant_of_run(scene, k), .ode = {}, .ode_count = 0});
    for (int j = 0; j < places; ++j) {
      const double share = static_cast<double>(j) / (places - 1);
      const Vec<Dim> low = vec_of<Dim>(scene.grid.low);
      Vec<Dim> x = low + share * (vec_of<Dim>(scene.grid.high) - low);
      const auto axis = static_cast<Eigen::Index>(opening.side / 2);
      x[axis] = opening.side % 2 == 0 ? scene.grid.low[opening.side / 2] : scene.grid.high[opening.side / 2];
      largest = std::max(largest, vector_at<Dim>(opening.velocity, arguments.at<Dim>(x)).norm());
    }
  }
  return largest;
}

template <int Dim>
std::vector<std::string> doubts_of_speeds(const Scene& scene, World& world) {
  std::vector<std::string> doubts;
  double largest = 0;
  for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) largest = std::max(largest, v.norm());
  doubt_of_speed("the liquid starts", largest, doubts);
  if (const auto* bodies = scene.facts.find<BodiesOfScene>()) {
    for (const auto& body : bodies->of<Dim>().bodies)
      doubt_of_speed(fmt::format("body \"{}\" moves", body.name), largest_speed_of<Dim>(body, scene), doubts);
  }
  if (const auto* openings = scene.facts.find<OpeningsOfScene>()) {
    for (const auto& opening : openings->of<Dim>().openings)
      doubt_of_speed(fmt::format("liquid comes in through \"{}\"", opening.name), largest_speed_of<Dim>(opening, scene),
                     doubts);
  }
  return doubts;
}

}  // namespace

std::vector<std::string> warnings_of_lengths(const Scene& scene) {
  std::vector<std::string> doubts;
  doubt_of_fall(scene, doubts);
  doubt_of_gravity(scene, doubts);
  doubt_of_tension(scene, doubts);
  return doubts;
}

std::vector<std::string> warnings_of_speeds(const Scene& scene, World& world) {
  return with_dimension(scene.dimension, [&](auto dim) { return doubts_of_speeds<dim()>(scene, world); });
}

}  // namespace minamo
