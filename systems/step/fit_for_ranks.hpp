#pragma once
/// \file
/// Which systems may run on several ranks. A system that only looks at particles and sites of its own may, and one that
/// adds up what ranks share; each has been made for it, so the list says which.

#include "systems/step/pipeline.hpp"

#include <string>

namespace minamo {

/// \throws InputError with a line per system of the run that knows nothing of other ranks.
void require_fit_for_ranks(const Pipeline& pipeline, const std::string& scene);

}  // namespace minamo
