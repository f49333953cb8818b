#include "problems.hpp"

#include "engine/schedule/schedule.hpp"
#include "tools/program/terminal.hpp"

#include <spdlog/details/null_mutex.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace minamo::python {

namespace {

/// Sets the exception of this name with these arguments.
template <class... Args>
void raise(const char* name, const Args&... arguments) {
  const py::object type = py::module_::import("minamo.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(arguments...).ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    py::list problems;
    for (const Problem& problem : error.problems()) problems.append(as_tuple(problem));
    raise("InputError", error.what(), problems);
  } catch (const ScheduleError& error) {
    raise("ScheduleError", error.what());
  } catch (const RunFailed& error) {
    raise("RunError", error.what());
  }
}

/// The interpreter's lock is the sink's: a second one could be waited for by who holds the first.
class PythonLog final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
  void sink_it_(const spdlog::details::log_msg& message) override {
    clear_foot();
    const py::gil_scoped_acquire lock;
    const py::object logger = py::module_::import("logging").attr("getLogger")("minamo");
    const bool is_warning = message.level >= spdlog::level::warn;
    logger.attr(is_warning ? "warning" : "info")("%s", py::str(message.payload.data(), message.payload.size()));
  }
  void flush_() override {}
};

}  // namespace

py::tuple as_tuple(const Problem& problem) {
  return py::make_tuple(problem.file, problem.pointer, problem.what, problem.expected, problem.got, problem.closest,
                        problem.text());
}

void translate_exceptions() { py::register_exception_translator(translate); }

void pass_log_on() {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("minamo", std::make_shared<PythonLog>()));
}

}  // namespace minamo::python
