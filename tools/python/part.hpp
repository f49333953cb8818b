#pragma once
/// \file
/// Parts that are written in python: a key of the scene with numbers, and the systems that they make.

#include "python_system.hpp"

#include "tools/program/scene_file.hpp"

#include <pybind11/stl.h>

namespace minamo::python {

/// A scene that was read, with what it holds on to.
struct PreparedScene {
  std::shared_ptr<SystemRegistry> registry;
  SceneFile file;
  std::string name;  ///< as the messages call it
  std::vector<std::shared_ptr<const PythonSystem>> systems;
  std::shared_ptr<Failures> failures;
};

/// Reads the scene and adds the systems to its slots.
/// \param text  the scene as JSON; none: it is in the file `name`
/// \param systems  minamo.System, each
/// \param parts  minamo.Part, each
/// \throws InputError with every problem
PreparedScene prepare_scene(const std::optional<std::string>& text, const std::string& name,
                            const py::iterable& systems, const py::iterable& parts);

/// \throws InputError if a system declares what no other of the scene names
void require_components(const PreparedScene& scene, const World& world);

}  // namespace minamo::python
