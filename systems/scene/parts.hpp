#pragma once
/// \file
/// The built-in parts: each registers its systems, its schemes, and itself. Each reads what those before it have read;
/// the order of the step is that of its table (systems/step/step_table.hpp).

#include "systems/scene/part.hpp"

namespace minamo {

void add_discretization(SystemRegistry& registry);   // step/
void add_ode(SystemRegistry& registry);              // time/
void add_grid(SystemRegistry& registry);             // grid/
void add_walls(SystemRegistry& registry);            // grid/
void add_quadrature(SystemRegistry& registry);       // equal_order/
void add_fluid(SystemRegistry& registry);            // step/
void add_bodies(SystemRegistry& registry);           // bodies/
void add_particles(SystemRegistry& registry);        // seeding/
void add_body_force(SystemRegistry& registry);       // time/
void add_openings(SystemRegistry& registry);         // openings/
void add_transfer(SystemRegistry& registry);         // step/
void add_sponge(SystemRegistry& registry);           // openings/
void add_integrator(SystemRegistry& registry);       // step/
void add_solver(SystemRegistry& registry);           // step/
void add_stabilization(SystemRegistry& registry);    // equal_order/
void add_volume(SystemRegistry& registry);           // step/
void add_time(SystemRegistry& registry);             // scene/
void add_conservation(SystemRegistry& registry);     // measure/
void add_surface_tension(SystemRegistry& registry);  // surface_tension/
void add_separating(SystemRegistry& registry);       // contact/
void add_probes(SystemRegistry& registry);           // measure/
void add_gauges(SystemRegistry& registry);           // measure/
void add_meters(SystemRegistry& registry);           // measure/
void add_patches(SystemRegistry& registry);          // measure/
void add_exact(SystemRegistry& registry);            // measure/
void add_output(SystemRegistry& registry);           // output/
void add_ranks(SystemRegistry& registry);            // ranks/

}  // namespace minamo
