#pragma once
/// \file
/// minamo from outside: write systems, register them, run the program with them.

#include "components/cells.hpp"
#include "components/energy_given.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/measure.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "engine/schedule/registry.hpp"
#include "engine/schedule/system.hpp"
#include "systems/transfer/scheme.hpp"

#include <functional>

namespace minamo {

/// The whole program: parses the command line, runs the command, returns the exit code (0 done, 2 bad input, 3 the run
/// failed, 130 interrupted).
/// \param add  registers further systems, which scenes can then name.
int run(int argc, const char* const* argv, const std::function<void(SystemRegistry&)>& add = {});

}  // namespace minamo
