#include "systems/setup/memory.hpp"

#include "systems/setup/time_plan.hpp"
#include "systems/solve/velocity_factors.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

int fewest_per_cell(const Scene& scene) {
  int fewest = 16;
  for (const ParticleScene& region : scene.particles) fewest = std::min(fewest, region.per_cell);
  return fewest;
}

/// Water that moves wets more nodes than at the start; in the plane the more, the fewer particles there are.
double spread(const Scene& scene) { return scene.dimension == 3 ? 2.5 : 1 + 6.0 / fewest_per_cell(scene); }

/// The longest step that a run can take: where the CFL number chooses it, one from rest. [s]
double longest_step(const Scene& scene) {
  if (scene.time.step) return *scene.time.step;
  double squared = 0;
  for (const Expression& force : scene.body_force) squared += force.is_constant() ? std::pow(force({}), 2) : 0;
  return step_of_cfl(scene, 0, std::sqrt(squared));
}

/// Whether friction couples the velocities of a step so much that the block solver may factorize them (E60).
bool is_stiff(const Scene& scene) {
  const double h = scene.grid.spacing;
  return scene.viscosity * longest_step(scene) > 0.1 * scene.density * h * h;
}

/// The block solver's: whole factors, of the velocities in stiff liquids, of the pressure where few particles have many
/// nodes, have more in a node the more nodes there are. In space those of the velocities end at a number of nodes.
double block_bytes_per_node(const Scene& scene, double nodes) {
  if (scene.dimension == 2) return 8e3 + (is_stiff(scene) ? 900 * std::log2(nodes) : 0);
  const double factorized = std::min(nodes, most_factorized_in_space / 3.0);
  const double of_velocity = is_stiff(scene) ? 6e3 * std::cbrt(factorized) * factorized / nodes : 0;
  const double of_pressure = fewest_per_cell(scene) == 1 ? 1.3e3 * std::cbrt(nodes) : 0;
  return 45e3 + of_velocity + of_pressure;
}

/// Matrices, and what the solver makes of them; a node of UMFPACK's factors has more the more nodes there are.
double bytes_per_node(const Scene& scene, double nodes) {
  const bool in_plane = scene.dimension == 2;
  if (scene.solver != "umfpack") return block_bytes_per_node(scene, nodes);
  const double coupled = scene.viscosity > 0 ? 1 : 0.5;  // without viscosity the directions are not coupled directly
  return in_plane ? 2e3 + coupled * 4e3 * std::log2(nodes) : 45e3 + coupled * 20e3 * std::cbrt(nodes);
}

}  // namespace

double memory_of(const Scene& scene, const SceneSize& size) {
  constexpr double program = 30e6;
  const double bytes_per_particle = scene.dimension == 2 ? 400 : 500;
  const double nodes = std::min(size.nodes * spread(scene), size.all_nodes);
  return program + bytes_per_particle * size.particles + bytes_per_node(scene, nodes) * nodes;
}

}  // namespace minamo
