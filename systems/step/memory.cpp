#include "systems/step/memory.hpp"

#include "systems/bodies/bodies_part.hpp"
#include "systems/bodies/coupling/cut_friction.hpp"
#include "systems/bodies/geometry/outlines.hpp"
#include "systems/grid/grid_of.hpp"
#include "systems/openings/openings_part.hpp"
#include "systems/output/surface/particle_surface.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/schemes.hpp"
#include "systems/viscosity/friction_choice.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Water that moves wets more nodes than at the start; in 2-D the more, the fewer particles there are.
double spread(const Scene& scene) { return scene.dimension == 3 ? 2.5 : 1 + 6.0 / fewest_per_cell(scene); }

/// Columns of faces and multipliers, what cells know of their sites, factors in 2-D and multigrid in 3-D.
double bytes_per_site(const Scene& scene) { return scene.dimension == 2 ? 2500 : 2000; }

/// Friction in the balances: matrices of cells, the vectors of its iteration and, in 3-D, coarser levels.
double bytes_of_friction(const Scene& scene) {
  if (friction_of(scene) != Friction::in_balances) return 0;
  return scene.dimension == 2 ? 800 : 1600;
}

double bytes_per_node_of(const Scene& scene, double nodes) {
  const auto& solver = scene.facts.get<LinearSolver>();
  if (!is_conforming(scene)) return solver.bytes_per_node(scene, nodes);
  // All equations at once have about as many entries as with equal order.
  const bool is_whole = solver.name == "umfpack";
  return bytes_per_site(scene) + bytes_of_friction(scene) + (is_whole ? solver.bytes_per_node(scene, nodes) : 0);
}

double bytes_of_bodies(const Scene& scene) {
  const auto* bodies = scene.facts.find<BodiesOfScene>();
  if (!bodies) return 0;
  return with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    const Bounds<Dim> box{vec_of<Dim>(scene.grid.low), vec_of<Dim>(scene.grid.high)};
    const double of_outlines = outlines_bytes<Dim>(bodies->of<Dim>(), box, scene.grid.spacing);
    if (!finds_friction(*bodies, scene)) return of_outlines;
    return of_outlines + cut_friction_bytes<Dim>(bodies->of<Dim>(), grid_of<Dim>(scene.grid),
                                                 scene.facts.get<Discretization>().degree);
  });
}

double bytes_of_surface(const Scene& scene) {
  if (scene.output.surface == "none") return 0;
  return with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    return surface_bytes<Dim>({vec_of<Dim>(scene.grid.low), vec_of<Dim>(scene.grid.high)},
                              scene.grid.spacing / fewest_per_cell(scene));
  });
}

/// What comes in may fill the box.
SceneSize grown(const Scene& scene, SceneSize size) {
  const auto* openings = scene.facts.find<OpeningsOfScene>();
  if (!openings || !has_inflow(*openings)) return size;
  double places = 1;
  for (const int cells : scene.grid.cells) places *= static_cast<double>(cells) * most_per_cell(*openings);
  size.particles = std::max(size.particles, places);
  size.nodes = size.all_nodes;
  return size;
}

}  // namespace

int fewest_per_cell(const Scene& scene) {
  int fewest = 16;
  for (const ParticleScene& region : scene.particles) fewest = std::min(fewest, region.per_cell);
  return fewest;
}

double memory_of(const Scene& scene, const SceneSize& at_start) {
  const SceneSize size = grown(scene, at_start);
  constexpr double program = 32e6;
  const double bytes_per_particle = scene.dimension == 2 ? 400 : 500;
  const double nodes = std::min(size.nodes * spread(scene), size.all_nodes);
  return program + bytes_per_particle * size.particles + bytes_per_node_of(scene, nodes) * nodes +
         bytes_of_bodies(scene) + bytes_of_surface(scene);
}

}  // namespace minamo
