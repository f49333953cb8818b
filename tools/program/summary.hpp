#pragma once
/// \file
/// summary.json: how a run went.

#include "engine/run/profiler.hpp"
#include "engine/run/simulation.hpp"
#include "tools/program/machine.hpp"

#include <nlohmann/json.hpp>

namespace minamo {

/// (E59) of the run so far, over all ranks. [1]
double energy_rise(World& world);

/// \param end  of the scene [s]
nlohmann::ordered_json make_summary(const std::string& scene, const Outcome& outcome, int threads, double end,
                                    const Stopwatch& stopwatch, const Profiler& profiler, World& world);

}  // namespace minamo
