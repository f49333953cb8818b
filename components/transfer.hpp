#pragma once
/// \file
/// What a transfer scheme does to the velocity of particles, for systems that have to know.

#include "engine/storage/component.hpp"

namespace minamo {

struct VelocityOfParticles {
  bool is_kept = false;  ///< changes of the grid's velocity are added, as by FLIP; else the grid's takes its place
  static constexpr ComponentInfo info{"transfer.velocity", "", "", Lifetime::constant};
};

}  // namespace minamo
