#include "systems/step/register.hpp"

#include "systems/scene/parts.hpp"

namespace minamo {

void register_parts(SystemRegistry& registry) {
  add_discretization(registry);
  add_ode(registry);
  add_grid(registry);
  add_walls(registry);
  add_quadrature(registry);
  add_fluid(registry);
  add_bodies(registry);
  add_particles(registry);
  add_body_force(registry);
  add_openings(registry);
  add_transfer(registry);
  add_sponge(registry);
  add_integrator(registry);
  add_solver(registry);
  add_stabilization(registry);
  add_volume(registry);
  add_time(registry);
  add_conservation(registry);
  add_surface_tension(registry);
  add_separating(registry);
  add_probes(registry);
  add_gauges(registry);
  add_meters(registry);
  add_patches(registry);
  add_exact(registry);
  add_output(registry);
  add_ranks(registry);
}

}  // namespace minamo
