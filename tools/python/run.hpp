#pragma once
/// \file
/// A run into a folder.

#include "part.hpp"

#include <optional>

namespace minamo::python {

/// Lets the process have so many threads, 0: one per processor. The limit is that of who wants most; each keeps to its
/// own in its task arena. \return how many
int allow_threads(int wanted);

/// What `minamo run` does, with Ctrl-C as a request to stop after the step.
/// \throws InputError, ScheduleError, RunFailed, KeyboardInterrupt
void run_into(PreparedScene scene, const std::string& folder, int threads, std::optional<std::int64_t> steps,
              bool resume, bool overwrite, bool quiet);

}  // namespace minamo::python
