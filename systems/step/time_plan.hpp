#pragma once
/// \file
/// Steps, frames and checkpoints as a scene wants them.

#include "engine/run/simulation.hpp"
#include "systems/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace minamo {

/// (E34)  How long steps may be in a liquid that a body force presses down: sqrt(h/|b|)/8 with Newmark's method,
/// sqrt(h/|b|)/3 with equal order; with exact integrals any where viscosity damps the shortest waves, else as with
/// equal order, half of it near rest and with bodies. None otherwise, nor without a body force. [s]
std::optional<double> gravity_step(const Scene& scene, double largest_speed, double largest_force);

/// A sentence where a fixed step is more than twice as long.
std::vector<std::string> warnings_of_gravity(const Scene& scene);

/// (E34)  With `cfl`, the step in which the fastest particle, pushed by the body force, crosses `cfl` cells:
/// (max |v_p| + |b| dt) dt = cfl h, at most `max_step`, the time between two frames, gravity_step(), and with surface
/// tension (E116). [s]
double step_of_cfl(const Scene& scene, double largest_speed, double largest_force);

/// The step; where the CFL number chooses it, one from rest: with exact integrals later ones may be twice as long. [s]
double step_from_rest(const Scene& scene);

/// Moving bodies cross `cfl` cells in a step at most, too, (E34).
TimePlan make_time_plan(const Scene& scene);

}  // namespace minamo
