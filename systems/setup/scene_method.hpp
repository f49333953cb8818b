#pragma once
/// \file
/// Reading of what a scene says about the method: transfer, integrator, stabilization, quadrature, volume, solver.

#include "systems/setup/scene.hpp"

namespace minamo {

void read_method(Input& input, const SystemRegistry& registry, Scene& scene);

}  // namespace minamo
