#pragma once
/// \file
/// (E129) How fast a liquid with a yield stress creeps below it, because its law is regularized.

#include "components/rheology.hpp"
#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace minamo {

/// A film on a plane under a force along it.
struct Film {
  double depth = 0;    ///< [m]
  double density = 0;  ///< [kg/m^3]
  double force = 0;    ///< per unit mass, along the plane; of grains all of it [m/s^2]
};

struct Creep {
  double depth = 0;  ///< of the film, or of what of it rests where it is too deep to rest [m]
  double speed = 0;  ///< of its surface, where it should be at rest [m/s]
  /// Of the surface of the film without yield stress; none of grains, whose friction has a most. [m/s]
  std::optional<double> unyielding;
};

/// (E129)  Surface speed, the integral of the rate at which the law has the stress rho b y; of grains on a slope of
/// their friction at rest. A film that its force shears beyond the yield stress is taken as deep as rests.
/// \return none of laws without yield stress, or without force
std::optional<Creep> creep_of(const rheology::Law& law, const Film& film);

/// A sentence for every liquid with a yield stress, on a film as deep as the liquid at the start.
std::vector<std::string> remarks_on_creep(const Scene& scene, World& world);

}  // namespace minamo
