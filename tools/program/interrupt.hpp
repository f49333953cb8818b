#pragma once
/// \file
/// Ctrl-C, termination and SIGUSR1, which batch systems send and mpirun passes on, as a request to stop after the step.

#include <atomic>

namespace minamo {

/// Catches SIGINT, SIGTERM and SIGUSR1 from the first call on; a second signal ends the program at once.
/// \return what such a signal sets.
const std::atomic<bool>& stop_on_signal();

}  // namespace minamo
