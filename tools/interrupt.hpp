#pragma once
/// \file
/// Ctrl-C and termination as a request to stop after the step.

#include <atomic>

namespace minamo {

/// Catches SIGINT and SIGTERM from the first call on; a second signal ends the program at once.
/// \return what such a signal sets.
const std::atomic<bool>& stop_on_signal();

}  // namespace minamo
