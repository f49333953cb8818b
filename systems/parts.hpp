#pragma once
/// \file
/// The built-in parts: each registers its systems, its schemes, and itself. Their order is the order within a slot.

#include "systems/setup/part.hpp"

namespace minamo {

void add_discretization(SystemRegistry& registry);   // conforming/
void add_ode(SystemRegistry& registry);              // time/
void add_grid(SystemRegistry& registry);             // grid/
void add_walls(SystemRegistry& registry);            // grid/
void add_quadrature(SystemRegistry& registry);       // assemble/
void add_fluid(SystemRegistry& registry);            // assemble/
void add_opening_faces(SystemRegistry& registry);    // openings/
void add_bodies(SystemRegistry& registry);           // bodies/
void add_particles(SystemRegistry& registry);        // setup/
void add_body_force(SystemRegistry& registry);       // time/
void add_openings(SystemRegistry& registry);         // openings/
void add_transfer(SystemRegistry& registry);         // transfer/
void add_sponge(SystemRegistry& registry);           // openings/
void add_integrator(SystemRegistry& registry);       // time/
void add_solver(SystemRegistry& registry);           // solve/
void add_stabilization(SystemRegistry& registry);    // assemble/
void add_volume(SystemRegistry& registry);           // volume/
void add_time(SystemRegistry& registry);             // setup/
void add_conservation(SystemRegistry& registry);     // measure/
void add_surface_tension(SystemRegistry& registry);  // surface_tension/
void add_separating(SystemRegistry& registry);       // separating/
void add_behind_bodies(SystemRegistry& registry);    // bodies/
void add_probes(SystemRegistry& registry);           // measure/
void add_gauges(SystemRegistry& registry);           // measure/
void add_meters(SystemRegistry& registry);           // measure/
void add_patches(SystemRegistry& registry);          // measure/
void add_exact(SystemRegistry& registry);            // measure/
void add_output(SystemRegistry& registry);           // output/
void add_behind_openings(SystemRegistry& registry);  // openings/
void add_ranks(SystemRegistry& registry);            // ranks/

}  // namespace minamo
