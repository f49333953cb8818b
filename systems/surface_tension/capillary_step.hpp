#pragma once
/// \file
/// How long steps may be with surface tension that is taken as the step finds it.

#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// (E116)  dt = sqrt(rho h^3/(2 pi sigma))/2, none without surface tension. J. U. Brackbill, D. B. Kothe, C. Zemach,
/// J. Comput. Phys. 100 (1992) 335, eq. (61), of one liquid alone. [s]
std::optional<double> capillary_step(const Scene& scene);

/// A sentence where a fixed step is longer.
std::vector<std::string> warnings_of_surface_tension(const Scene& scene);

}  // namespace minamo
