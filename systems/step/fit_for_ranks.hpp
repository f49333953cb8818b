#pragma once
/// \file
/// Refuses a run on several ranks that has systems which were not made for it, as OnRanks at their registration says.

#include "systems/step/pipeline.hpp"

#include <string>

namespace minamo {

/// \throws InputError with a line per system of the run that knows nothing of other ranks.
void require_fit_for_ranks(const Pipeline& pipeline, const std::string& scene);

}  // namespace minamo
