#pragma once
/// \file
/// What a python function declares as a system, and what is wrong with it.

#include "described_column.hpp"

#include "engine/input/problem.hpp"
#include "engine/schedule/registry.hpp"

#include <pybind11/pybind11.h>

#include <map>

namespace minamo::python {

namespace py = pybind11;

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

/// Whether systems can have a resource of that name, which is no column.
bool is_resource_for_python(std::string_view name);

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

/// What messages call it: `system "damp"`.
std::string place_of(const PythonSystem& system);

}  // namespace minamo::python
