#pragma once
/// \file
/// The one list of built-in systems and transfer schemes.

#include "engine/schedule/registry.hpp"

namespace minamo {

void register_parts(SystemRegistry& registry);

}  // namespace minamo
