#include "systems/seeding/seed_particles.hpp"

#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/vector_text.hpp"
#include "engine/run/communicator.hpp"
#include "systems/scene/scene.hpp"
#include "systems/seeding/lay_out.hpp"
#include "systems/seeding/regions.hpp"
#include "systems/transfer/scheme.hpp"

#include <cmath>

namespace minamo {

namespace {

/// A vector of expressions at a place, at t = 0.
template <int Dim>
Vec<Dim> value_at(const std::vector<Expression>& expressions, const Vec<Dim>& x, const Instant& start) {
  Arguments arguments(start);
  return vector_at<Dim>(expressions, arguments.at<Dim>(x));
}

/// Central differences.
template <int Dim>
Mat<Dim> velocity_gradient_at(const std::vector<Expression>& velocity, const Vec<Dim>& x, const Instant& start,
                              double spacing) {
  const double step = 1e-3 * spacing;
  Mat<Dim> gradient;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> aside = step * Vec<Dim>::Unit(d);
    gradient.col(d) =
        (value_at<Dim>(velocity, x + aside, start) - value_at<Dim>(velocity, x - aside, start)) / (2 * step);
  }
  return gradient;
}

/// Of the liquid in a region.
double density_of(const Scene& scene, std::size_t region) {
  const auto* fluids = scene.facts.find<Fluids>();
  return fluids == nullptr ? scene.facts.get<Fluid>().density
                           : fluids->of[scene.facts.get<FluidsOfRegions>().of[region]].density;
}

/// Numbers of particles, region by region, as if one process had laid them out: those with their middle inside, then
/// those beyond.
template <int Dim>
std::vector<std::int64_t> numbers_of(const Seeds<Dim>& seeds, std::size_t regions) {
  std::vector<std::size_t> group(seeds.region.size());
  for (std::size_t p = 0; p < group.size(); ++p) group[p] = 2 * seeds.region[p] + seeds.is_beyond[p];
  std::vector<std::int64_t> next(2 * regions, 0);
  for (const std::size_t g : group) ++next[g];
  std::int64_t before = 0;
  for (std::int64_t& count : next) {
    const std::int64_t own = count;
    count = before + (all_ranks() == nullptr ? 0 : all_ranks()->sum_below(own));
    before += sum_over_ranks(own);
  }
  std::vector<std::int64_t> numbers;
  for (const std::size_t g : group) numbers.push_back(next[g]++);
  return numbers;
}

/// (E6)  V_p = (h/n)^d for n per cell and direction, m_p = rho V_p, v_p = v(x_p), grad v_p by central differences.
template <int Dim>
void set_particles(const Scene& scene, const Grid<Dim>& grid, const Seeds<Dim>& seeds, World& world,
                   SeedProblems& problems) {
  world.resize<Particles>(seeds.position.size());
  const bool with_gradient = scene.facts.get<TransferScheme>().carries_gradient;
  const auto x_p = world.column<particle::Position<Dim>>();
  const auto v_p = world.column<particle::Velocity<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  const auto V_p = world.column<particle::Volume>();
  const auto numbers = numbers_of<Dim>(seeds, scene.particles.size());
  std::copy(numbers.begin(), numbers.end(), world.column<particle::Id>().begin());
  const auto grad_v_p = with_gradient ? world.column<particle::VelocityGradient<Dim>>() : std::span<Mat<Dim>>{};
  const Instant start = scene.start;
  const auto k_p = scene.facts.find<Fluids>() ? world.column<particle::FluidIndex>() : std::span<std::int64_t>{};
  const std::vector<std::size_t>& fluid_of_region = scene.facts.get<FluidsOfRegions>().of;
  std::vector<double> density;
  for (std::size_t r = 0; r < scene.particles.size(); ++r) density.push_back(density_of(scene, r));
  std::vector<bool> reported(scene.particles.size(), false);
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const std::size_t r = seeds.region[p];
    const ParticleScene& region = scene.particles[r];
    x_p[p] = seeds.position[p];
    V_p[p] = seeds.share[p] * std::pow(grid.spacing / region.per_cell, Dim);
    m_p[p] = density[r] * V_p[p];
    if (!k_p.empty()) k_p[p] = static_cast<std::int64_t>(fluid_of_region[r]);
    v_p[p] = value_at<Dim>(region.velocity, x_p[p], start);
    if (with_gradient) grad_v_p[p] = velocity_gradient_at<Dim>(region.velocity, x_p[p], start, grid.spacing);
    const bool finite = v_p[p].allFinite() && (!with_gradient || grad_v_p[p].allFinite());
    if (finite || reported[r]) continue;
    reported[r] = true;
    problems.note(fmt::format("/particles/{}/velocity", r), "not finite", "a finite velocity [m/s]",
                  fmt::format("{} at {}", v_p[p].allFinite() ? "no finite gradient" : vector_text<Dim>(v_p[p]),
                              place_text<Dim>(x_p[p])));
  }
}

/// Of every region a particle must weigh something, and not infinitely much.
template <int Dim>
void check_mass(const Scene& scene, const Grid<Dim>& grid, SeedProblems& problems) {
  const auto* fluids = scene.facts.find<Fluids>();
  for (std::size_t r = 0; r < scene.particles.size(); ++r) {
    const double density = density_of(scene, r);
    const double mass = density * std::pow(grid.spacing / scene.particles[r].per_cell, Dim);
    if (std::isnormal(mass)) continue;
    problems.note(fluids == nullptr
                      ? "/fluid/density"
                      : fmt::format("/fluids/{}/density", fluids->names[scene.facts.get<FluidsOfRegions>().of[r]]),
                  "particles without a mass", "a density with which they have one",
                  fmt::format("{} kg/m^3, particles of {} kg", density, mass));
    return;
  }
}

}  // namespace

template <int Dim>
void seed_particles(const Scene& scene, World& world, SeedProblems& problems) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  check_mass<Dim>(scene, grid, problems);
  set_particles<Dim>(scene, grid, lay_out<Dim>(scene, grid, world, problems), world, problems);
}

template void seed_particles<2>(const Scene&, World&, SeedProblems&);
template void seed_particles<3>(const Scene&, World&, SeedProblems&);

}  // namespace minamo
