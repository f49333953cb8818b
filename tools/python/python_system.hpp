#pragma once
/// \file
/// Systems that are python functions: they get arrays of the columns that they declare, and nothing else.

#include "columns.hpp"
#include "declaration.hpp"

#include <deque>
#include <optional>

namespace minamo::python {

/// What a python system was when it failed, kept until the step has ended: arrays that somebody still holds, which must
/// not lose their memory, and the exception, which must not be lost on its way through the schedule.
class Failures {
 public:
  /// \return a number by which take() finds it again
  std::size_t add(Views views, std::optional<py::error_already_set> error);
  /// The arrays keep what they have; then the exception is thrown again. \pre the step has ended
  void rethrow(std::size_t number);
  /// Like rethrow() of the first, if there is one.
  void rethrow_first();

 private:
  struct Failure {
    Views views;
    std::optional<py::error_already_set> error;
  };
  void detach_all();
  std::deque<Failure> failures_;
};

/// Goes through the schedule in place of a python exception, which wants the interpreter's lock wherever it is copied.
class PythonFailure : public std::runtime_error {
 public:
  PythonFailure(const std::string& what, std::size_t number) : std::runtime_error(what), number_(number) {}
  std::size_t number() const { return number_; }

 private:
  std::size_t number_;
};

/// \pre problems_of() finds none.
System make_system(std::shared_ptr<const PythonSystem> system, const KnownComponents& known, int dimension,
                   std::shared_ptr<Failures> failures);

/// `measure.columns` while a system runs.
class HistoryColumns;
void bind_arguments(py::module_& module);

}  // namespace minamo::python
