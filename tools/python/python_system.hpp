#pragma once
/// \file
/// Systems that are python functions: they get arrays of the columns that they declare, and nothing else.

#include "columns.hpp"
#include "described_column.hpp"

#include "engine/problem.hpp"
#include "engine/registry.hpp"

#include <deque>
#include <map>
#include <mutex>
#include <optional>

namespace minamo::python {

/// Every component that some system of the program names, as its accesses do.
class KnownComponents {
 public:
  KnownComponents(const SystemRegistry& registry, int dimension);
  /// Null if there is none of that name.
  const Access* find(std::string_view name) const;
  /// The table of that name as a text that is never freed; empty if there is none.
  std::string_view table(std::string_view name) const;
  std::vector<std::string> names() const;
  std::vector<std::string> tables() const;

 private:
  std::map<std::string, Access, std::less<>> by_name_;
};

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

/// One of the arguments of a python function.
struct Declared {
  Mode mode;
  std::string component;
  std::shared_ptr<const DescribedColumn> described;  ///< null for a component of the program
};

/// A function with its declaration, from minamo.System.
struct PythonSystem {
  explicit PythonSystem(const py::handle& system);
  ~PythonSystem();
  PythonSystem(const PythonSystem&) = delete;
  PythonSystem& operator=(const PythonSystem&) = delete;

  std::string name;
  std::string slot;
  bool standing;
  std::vector<Declared> declared;
  py::object function;
};

/// What is wrong with the declaration.
std::vector<Problem> problems_of(const PythonSystem& system, const KnownComponents& known);

/// What declares a component that no other system of the scene names, so that nothing makes it.
std::vector<Problem> missing_components(const PythonSystem& system, const World& world);

/// \pre problems_of() finds none.
System make_system(std::shared_ptr<const PythonSystem> system, const KnownComponents& known, int dimension,
                   std::shared_ptr<Failures> failures);

/// `measure.columns` while a system runs.
class HistoryColumns;
void bind_arguments(py::module_& module);

}  // namespace minamo::python
