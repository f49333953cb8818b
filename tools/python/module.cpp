/// \file
/// The extension that the package minamo wraps; what users call is described in package/minamo.

#include "listings.hpp"
#include "problems.hpp"
#include "run.hpp"
#include "simulation.hpp"

#include <minamo_version.hpp>

#include <pybind11/stl.h>

PYBIND11_MODULE(_minamo, module) {
  using namespace minamo::python;
  module.doc() = "The extension below the package minamo, whose functions and classes are what to use.";
  module.attr("__version__") = std::string(minamo::version);
  translate_exceptions();
  pass_log_on();
  bind_arguments(module);
  module.def("list", &list);
  module.def("check", &check);
  module.def("schema", &schema);
  module.def("run", [](const std::optional<std::string>& text, const std::string& name, const py::iterable& systems,
                       const py::iterable& parts, const std::string& folder, int threads,
                       std::optional<std::int64_t> steps, bool resume, bool overwrite, bool quiet) {
    run_into(prepare_scene(text, name, systems, parts), folder, threads, steps, resume, overwrite, quiet);
  });
  py::class_<Simulation>(module, "Simulation")
      .def(py::init([](const std::optional<std::string>& text, const std::string& name, const py::iterable& systems,
                       const py::iterable& parts, int threads) {
        return std::make_unique<Simulation>(prepare_scene(text, name, systems, parts), threads);
      }))
      .def("advance", &Simulation::advance)
      .def("column", &Simulation::column)
      .def("columns", &Simulation::columns)
      .def("scene", &Simulation::scene)
      .def("history", &Simulation::history)
      .def("history_rows", &Simulation::history_rows)
      .def("history_columns", &Simulation::history_columns)
      .def_property_readonly("time", &Simulation::time)
      .def_property_readonly("last_step", &Simulation::last_step)
      .def_property_readonly("steps", &Simulation::steps)
      .def_property_readonly("rejected", &Simulation::rejected)
      .def_property_readonly("is_over", &Simulation::is_over)
      .def_property_readonly("dimension", &Simulation::dimension)
      .def_property_readonly("threads", &Simulation::threads)
      .def_property_readonly("grid", &Simulation::grid);
}
