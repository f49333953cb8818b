#pragma once
/// \file
/// What `minamo list`, `minamo check` and `minamo schema` tell, as python lists and dicts.

#include "problems.hpp"

#include <optional>
#include <string>

namespace minamo::python {

/// \param what  parts, schemes, solvers, systems or components
/// \throws InputError for another word
py::list list(const std::string& what);

/// The problems of a scene, each as_tuple(); empty if there are none.
py::list check(const std::optional<std::string>& text, const std::string& name, const py::iterable& systems,
               const py::iterable& parts);

/// The JSON Schema of a scene, as text.
std::string schema();

}  // namespace minamo::python
