#include "systems/setup/memory.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Water that moves wets more nodes than at the start; in the plane the more, the fewer particles there are.
double spread(const Scene& scene) {
  if (scene.dimension == 3) return 2.5;
  double fewest = 16;
  for (const ParticleScene& region : scene.particles) fewest = std::min<double>(fewest, region.per_cell);
  return 1 + 6 / fewest;
}

/// Matrices, and what the solver makes of them; a node of UMFPACK's factors has more the more nodes there are.
double bytes_per_node(const Scene& scene, double nodes) {
  const bool in_plane = scene.dimension == 2;
  if (scene.solver != "umfpack") return in_plane ? 8e3 : 45e3;
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
