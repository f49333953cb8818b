#pragma once
/// \file
/// What a scene measures beside the flow: its ode variables, its exact solution, its probes.

#include "systems/setup/scene.hpp"

namespace minamo {

/// Variables with a bad name are left out, so that expressions know the others.
std::vector<OdeScene> read_ode(Input& input, const std::map<std::string, double>& constants);

/// \pre the constants, the ode variables and the dimension of the scene are read.
ExactScene read_exact(Input& input, const Scene& scene);

/// \pre the grid of the scene is read.
std::vector<ProbeScene> read_probes(Input& input, const Scene& scene);

}  // namespace minamo
