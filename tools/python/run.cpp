#include "run.hpp"

#include "problems.hpp"

#include "tools/program/machine.hpp"
#include "tools/program/single_run.hpp"

#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <csignal>

namespace minamo::python {

int allow_threads(int wanted) {
  static int most = 0;
  if (wanted == 0 || wanted > most) most = prepare_threads(wanted);
  return wanted == 0 ? most : wanted;
}

namespace {

std::atomic<bool> stop_requested = false;

/// While it lives Ctrl-C asks the run to stop.
class StopOnSignal {
 public:
  StopOnSignal() {
    stop_requested = false;
    before_ = std::signal(SIGINT, [](int) { stop_requested = true; });
  }
  ~StopOnSignal() { std::signal(SIGINT, before_); }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  void (*before_)(int);
};

}  // namespace

void run_into(PreparedScene scene, const std::string& folder, int threads, std::optional<std::int64_t> steps,
              bool resume, bool overwrite, bool quiet) {
  const RunPlan plan{.scene = scene.name,
                     .folder = folder,
                     .threads = allow_threads(threads),
                     .steps = steps,
                     .beginning = resume ? Beginning::continuation : Beginning::start,
                     .replaced = overwrite ? Replaced::all_runs : Replaced::finished_runs,
                     .quiet = quiet,
                     .at_end = {}};
  RunResult result;
  {
    const py::gil_scoped_release unlocked;
    const StopOnSignal stop;
    Profiler profiler(false);
    tbb::task_arena arena(plan.threads);
    arena.execute([&] { result = run_into_folder(scene.file, plan, profiler, stop_requested); });
  }
  scene.failures->rethrow_first();
  if (result.outcome.ending == Ending::failed) throw RunFailed(result.outcome.message);
  if (result.outcome.ending == Ending::interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
}

}  // namespace minamo::python
