#pragma once
/// \file
/// The program's messages as python exceptions, and its log as python's.

#include "engine/input/problem.hpp"

#include <pybind11/pybind11.h>

namespace minamo::python {

namespace py = pybind11;

/// A run that has failed, as the program's exit code 3. The state is the last accepted one.
class RunFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `(file, pointer, what, expected, got, closest, text)`, the arguments of minamo.Problem.
py::tuple as_tuple(const Problem& problem);

/// InputError, ScheduleError and RunFailed become the exceptions of minamo.errors.
void translate_exceptions();

/// Warnings of the library go to logging.getLogger("minamo").
void pass_log_on();

}  // namespace minamo::python
