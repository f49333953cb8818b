#include "systems/setup/seed.hpp"

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "systems/setup/lattice.hpp"
#include "systems/setup/seed_measure.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <unordered_map>

namespace minamo {

namespace {

template <int Dim>
Grid<Dim> make_grid(const GridScene& scene, const std::vector<std::array<Wall, 2>>& walls) {
  Grid<Dim> grid;
  grid.spacing = scene.spacing;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    grid.low[axis] = scene.low[d];
    grid.high[axis] = scene.high[d];
    grid.cells[d] = scene.cells[d];
    grid.periodic[d] = walls[d][0] == Wall::periodic;
  }
  return grid;
}

/// The directions that a wall of an axis holds.
template <int Dim>
std::uint8_t held_by(Wall wall, std::size_t axis) {
  constexpr auto all = static_cast<std::uint8_t>((1 << Dim) - 1);
  if (wall == Wall::periodic) return 0;
  return wall == Wall::no_slip ? all : static_cast<std::uint8_t>(1U << axis);
}

template <int Dim>
Walls<Dim> make_walls(const std::vector<std::array<Wall, 2>>& scene) {
  Walls<Dim> walls;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t end = 0; end < 2; ++end) walls.held[d][end] = held_by<Dim>(scene[d][end], d);
  }
  return walls;
}

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

template <int Dim>
std::string place_text(const Vec<Dim>& x) {
  std::string text = fmt::format("x = {:.6g}, y = {:.6g}", x[0], x[1]);
  if constexpr (Dim == 3) text += fmt::format(", z = {:.6g}", x[2]);
  return text;
}

template <int Dim>
std::string vector_text(const Vec<Dim>& v) {
  std::string text;
  for (const double x : v)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", std::isnan(x) ? "nan" : fmt::format("{:.6g}", x));
  return "[" + text + ']';
}

/// Positions, and the region that each comes from.
template <int Dim>
struct Seeds {
  std::vector<Vec<Dim>> position;
  std::vector<std::size_t> region;
};

template <int Dim>
Seeds<Dim> lay_out(const Scene& scene, const Grid<Dim>& grid, const std::string& file, std::vector<Problem>& problems) {
  Seeds<Dim> seeds;
  std::unordered_map<std::size_t, double> filled;
  for (std::size_t r = 0; r < scene.particles.size(); ++r) {
    const ParticleScene& region = scene.particles[r];
    const bool moves = scene.quadrature == "mixed" && !region.jitter;
    const auto positions = lattice<Dim>(region, grid, start_of(scene));
    const std::string pointer = fmt::format("/particles/{}", r);
    if (positions.empty()) {
      problems.push_back({file, pointer + "/shape", "no particle inside", "a shape that holds at least one particle",
                          fmt::format("none at {} per cell and direction", region.per_cell), ""});
    }
    const double share = std::pow(region.per_cell, -Dim);
    const Vec<Dim>* overlap = nullptr;
    for (const Vec<Dim>& x : positions) {
      double& cell = filled[grid.row(cell_of<Dim>(grid, x))];
      cell += share;
      if (cell > 1 + 1e-9 && !overlap) overlap = &x;
      seeds.position.push_back(moves ? nearer_to_walls<Dim>(grid, region.per_cell, x) : x);
      seeds.region.push_back(r);
    }
    if (overlap) {
      problems.push_back({file, pointer + "/shape", "overlaps an earlier one", "no cell more than full",
                          "more than a full cell at " + place_text<Dim>(*overlap), ""});
    }
  }
  return seeds;
}

/// (E6)  V_p = (h/n)^d for n per cell and direction, m_p = rho V_p, v_p = v(x_p), grad v_p by central differences.
template <int Dim>
void set_particles(const Scene& scene, const Grid<Dim>& grid, const Seeds<Dim>& seeds, const std::string& file,
                   World& world, std::vector<Problem>& problems) {
  world.resize<Particles>(seeds.position.size());
  const bool with_gradient = scene.transfer_scheme.carries_gradient;
  const auto x_p = world.column<particle::Position<Dim>>();
  const auto v_p = world.column<particle::Velocity<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  const auto V_p = world.column<particle::Volume>();
  const auto id = world.column<particle::Id>();
  const auto grad_v_p = with_gradient ? world.column<particle::VelocityGradient<Dim>>() : std::span<Mat<Dim>>{};
  const Instant start = start_of(scene);
  std::vector<bool> reported(scene.particles.size(), false);
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const std::size_t r = seeds.region[p];
    const ParticleScene& region = scene.particles[r];
    x_p[p] = seeds.position[p];
    id[p] = static_cast<std::int64_t>(p);
    V_p[p] = std::pow(grid.spacing / region.per_cell, Dim);
    m_p[p] = scene.density * V_p[p];
    v_p[p] = value_at<Dim>(region.velocity, x_p[p], start);
    if (with_gradient) grad_v_p[p] = velocity_gradient_at<Dim>(region.velocity, x_p[p], start, grid.spacing);
    const bool finite = v_p[p].allFinite() && (!with_gradient || grad_v_p[p].allFinite());
    if (finite || reported[r]) continue;
    reported[r] = true;
    problems.push_back({file, fmt::format("/particles/{}/velocity", r), "not finite", "a finite velocity [m/s]",
                        fmt::format("{} at {}", v_p[p].allFinite() ? "no finite gradient" : vector_text<Dim>(v_p[p]),
                                    place_text<Dim>(x_p[p])),
                        ""});
  }
}

/// Of every region a particle must weigh something, and not infinitely much.
template <int Dim>
void check_mass(const Scene& scene, const Grid<Dim>& grid, const std::string& file, std::vector<Problem>& problems) {
  for (const ParticleScene& region : scene.particles) {
    const double mass = scene.density * std::pow(grid.spacing / region.per_cell, Dim);
    if (std::isnormal(mass)) continue;
    problems.push_back({file, "/fluid/density", "particles without a mass", "a density with which they have one",
                        fmt::format("{} kg/m^3, particles of {} kg", scene.density, mass), ""});
    return;
  }
}

/// Where a run with orthogonal subscales starts from: the pressure gradient of a liquid at rest.
template <int Dim>
void set_pressure_gradient(const Scene& scene, World& world) {
  if (scene.stabilization != "oss") return;
  const auto x_p = world.column<particle::Position<Dim>>();
  const auto grad_p_p = world.column<particle::PressureGradient<Dim>>();
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    grad_p_p[p] = scene.density * value_at<Dim>(scene.body_force, x_p[p], start_of(scene));
  }
}

/// The body force must be finite where the liquid starts.
template <int Dim>
void check_body_force(const Scene& scene, const Seeds<Dim>& seeds, const std::string& file,
                      std::vector<Problem>& problems) {
  for (const Vec<Dim>& x : seeds.position) {
    const Vec<Dim> b = value_at<Dim>(scene.body_force, x, start_of(scene));
    if (b.allFinite()) continue;
    problems.push_back({file, "/body_force", "not finite", "a finite force per unit mass [m/s^2]",
                        fmt::format("{} at {}, t = 0", vector_text<Dim>(b), place_text<Dim>(x)), ""});
    return;
  }
}

}  // namespace

template <int Dim>
void seed_world(const Scene& scene, const std::string& file, World& world) {
  const Grid<Dim> grid = make_grid<Dim>(scene.grid, scene.walls);
  world.resource<Grid<Dim>>() = grid;
  world.resource<Fluid>() = {scene.density, scene.viscosity};
  world.resource<BodyForce>() = {scene.body_force};
  world.resource<NewmarkParameters>() = {scene.newmark_beta, scene.newmark_gamma};
  world.resource<VolumeRate>() = {scene.volume_rate};
  // A step that was chosen by its CFL number may come out faster than the particles were before it.
  auto& largest = world.resource<LargestMove>();
  largest.cells = std::max(largest.cells, 2 * scene.time.cfl);
  world.resource<SolverTolerance>() = {scene.solver_tolerance};
  world.resource<FilterOrder>() = {scene.filter_order};
  world.resource<FlipBlend>() = {scene.flip_blend};
  world.resource<Walls<Dim>>() = make_walls<Dim>(scene.walls);
  std::vector<Problem> problems;
  check_mass<Dim>(scene, grid, file, problems);
  const Seeds<Dim> seeds = lay_out<Dim>(scene, grid, file, problems);
  set_particles<Dim>(scene, grid, seeds, file, world, problems);
  set_pressure_gradient<Dim>(scene, world);
  check_body_force<Dim>(scene, seeds, file, problems);
  seed_measure<Dim>(scene, file, world, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
}

template void seed_world<2>(const Scene&, const std::string&, World&);
template void seed_world<3>(const Scene&, const std::string&, World&);

}  // namespace minamo
