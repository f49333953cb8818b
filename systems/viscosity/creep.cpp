#include "systems/viscosity/creep.hpp"

#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "components/instant.hpp"
#include "components/rheology.hpp"
#include "systems/viscosity/law.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace minamo {

namespace {

using namespace rheology;

/// The rate at which a law has a stress: the stress rises with the rate. [1/s]
double rate_at(const Law& law, double stress, double pressure) {
  constexpr double least = 1e-15;
  constexpr double most = 1e15;
  double low = std::log(least);
  double high = std::log(most);
  // Down to rounding.
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = 0.5 * (low + high);
    const double rate = std::exp(middle);
    (viscosity_at(law, rate, pressure) * rate < stress ? low : high) = middle;
  }
  return std::exp(low);
}

/// Integral of the rate over the depth of a film, from the surface down. [m/s]
template <class Stress, class Pressure>
double surface_speed(const Law& law, double depth, const Stress& stress, const Pressure& pressure) {
  constexpr int slices = 200;  // a hundredth of the speed is enough
  double speed = 0;
  for (int k = 0; k < slices; ++k) {
    const double y = (k + 0.5) * depth / slices;
    speed += depth / slices * rate_at(law, stress(y), pressure(y));
  }
  return speed;
}

/// Speed of the surface of a film of a power law. [m/s]
double power_law_speed(double consistency, double index, double wall_stress, double depth) {
  return index / (index + 1) * std::pow(wall_stress / consistency, 1 / index) * depth;
}

std::optional<Creep> of_yield_stress(const Law& law, double yield_stress, double consistency, double index,
                                     const Film& film) {
  const double per_depth = film.density * film.force;
  if (per_depth <= 0 || film.depth <= 0) return {};
  const double depth = std::min(film.depth, yield_stress / per_depth);
  const double speed = surface_speed(
      law, depth, [&](double y) { return per_depth * y; }, [](double) { return 0.0; });
  return Creep{depth, speed, power_law_speed(consistency, index, per_depth * depth, depth)};
}

std::optional<Creep> creep(const Bingham& law, const Film& film) {
  return of_yield_stress(law, law.yield_stress, law.viscosity, 1, film);
}
std::optional<Creep> creep(const HerschelBulkley& law, const Film& film) {
  return of_yield_stress(law, law.yield_stress, law.consistency, law.index, film);
}
std::optional<Creep> creep(const MuI& law, const Film& film) {
  if (film.force <= 0 || film.depth <= 0) return {};
  // On a slope of their angle of rest, tan = mu_s.
  const double pressure_per_depth = film.density * film.force / std::sqrt(1 + law.least * law.least);
  const auto pressure = [&](double y) { return pressure_per_depth * y; };
  return Creep{film.depth,
               surface_speed(
                   law, film.depth, [&](double y) { return law.least * pressure(y); }, pressure),
               {}};
}
std::optional<Creep> creep(const PowerLaw&, const Film&) { return {}; }
std::optional<Creep> creep(const Carreau&, const Film&) { return {}; }

double regularization_of(const Law& law) {
  return std::visit(
      [](const auto& of) {
        if constexpr (requires { of.regularization; }) return of.regularization;
        return 0.0;
      },
      law);
}

/// What of the body force drives a film: that along periodic axes, if there is one, which no wall holds; else all.
template <int Dim>
struct Drive {
  double force = 0;                                             ///< [m/s^2]
  std::array<bool, static_cast<std::size_t>(Dim)> is_across{};  ///< axes along which a film may have its depth
};

template <int Dim>
Drive<Dim> drive_of(const BodyForce& b, const Grid<Dim>& grid, const Instant& start, const Vec<Dim>& middle) {
  Arguments arguments(start);
  const Vec<Dim> force = vector_at<Dim>(b.of_place_and_time, arguments.at<Dim>(middle));
  Vec<Dim> along = Vec<Dim>::Zero();
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)]) along[d] = force[d];
  }
  Drive<Dim> drive{along.isZero(0) ? force.norm() : along.norm(), {}};
  const bool pulls_across = !(force - along).isZero(0);
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    drive.is_across[axis] = !grid.periodic[axis] && (force[d] != 0 || !pulls_across);
  }
  return drive;
}

/// Particles of a liquid as a film.
template <int Dim>
Film film_of(const Scene& scene, World& world, std::size_t liquid, double density) {
  const auto x_p = world.column<particle::Position<Dim>>();
  const bool has_several = world.has<particle::FluidIndex>();
  Vec<Dim> low = Vec<Dim>::Constant(std::numeric_limits<double>::infinity());
  Vec<Dim> high = -low;
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    if (has_several && static_cast<std::size_t>(world.column<particle::FluidIndex>()[p]) != liquid) continue;
    low = low.cwiseMin(x_p[p]);
    high = high.cwiseMax(x_p[p]);
  }
  if (!(low.array() <= high.array()).all()) return {};
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const auto drive = drive_of<Dim>(scene.facts.get<BodyForce>(), grid, scene.start, 0.5 * (low + high));
  double depth = std::numeric_limits<double>::infinity();
  for (int d = 0; d < Dim; ++d) {
    if (drive.is_across[static_cast<std::size_t>(d)]) depth = std::min(depth, high[d] - low[d]);
  }
  // From the outermost particles to the surface there is half of their spacing on both sides.
  const double between = std::pow(world.column<particle::Volume>()[0], 1.0 / Dim);
  return {std::isfinite(depth) ? depth + between : 0, density, drive.force};
}

std::string text_of(const Law& law, const Creep& creep) {
  std::string text = fmt::format("below its yield stress the liquid creeps, by regularization {:g}: where it is {:.3g} "
                                 "m deep and should rest, at up to {:.2g} m/s",
                                 regularization_of(law), creep.depth, creep.speed);
  if (creep.unyielding)
    text += fmt::format(", {:.2g} % of its speed without yield stress", 100 * creep.speed / *creep.unyielding);
  return text;
}

}  // namespace

std::optional<Creep> creep_of(const Law& law, const Film& film) {
  return std::visit([&](const auto& of) { return creep(of, film); }, law);
}

std::vector<std::string> remarks_on_creep(const Scene& scene, World& world) {
  const auto* rheology = scene.facts.find<Rheology>();
  if (rheology == nullptr || world.rows<Particles>() == 0) return {};
  std::vector<std::string> remarks;
  const auto* fluids = scene.facts.find<Fluids>();
  for (std::size_t k = 0; k < rheology->laws.size(); ++k) {
    const Fluid& fluid = fluids == nullptr ? scene.facts.get<Fluid>() : fluids->of[k];
    const auto film =
        with_dimension(scene.dimension, [&](auto dim) { return film_of<dim()>(scene, world, k, fluid.density); });
    const auto creep = creep_of(rheology->laws[k], film);
    if (creep) remarks.push_back(text_of(rheology->laws[k], *creep));
  }
  return remarks;
}

}  // namespace minamo
