#include "declaration.hpp"

#include "components/measure.hpp"
#include "engine/run/clock.hpp"
#include "systems/scene/part.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo::python {

namespace {

constexpr std::string_view clock_name = Clock::info.name;
constexpr std::string_view history_name = measure::Columns::info.name;

}  // namespace

bool is_resource_for_python(std::string_view name) { return name == clock_name || name == history_name; }

std::string place_of(const PythonSystem& system) { return "system \"" + system.name + "\""; }

KnownComponents::KnownComponents(const SystemRegistry& registry, int dimension) {
  for (const auto& [name, entry] : registry.entries()) {
    for (const Access& access : entry.make(dimension, nullptr).access) {
      if (access.info) by_name_.emplace(access.component, access);
    }
  }
}

const Access* KnownComponents::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &found->second;
}

std::string_view KnownComponents::table(std::string_view name) const {
  for (const auto& [component, access] : by_name_) {
    if (access.table == name) return access.table;
  }
  return {};
}

std::vector<std::string> KnownComponents::names() const {
  std::vector<std::string> names;
  for (const auto& [name, access] : by_name_) names.push_back(name);
  return names;
}

std::vector<std::string> KnownComponents::tables() const {
  std::vector<std::string> tables;
  for (const auto& [name, access] : by_name_) {
    const std::string table(access.table);
    if (!table.empty() && std::find(tables.begin(), tables.end(), table) == tables.end()) tables.push_back(table);
  }
  return tables;
}

namespace {

py::handle require_system(const py::handle& system) {
  if (py::isinstance(system, py::module_::import("minamo.systems").attr("System"))) return system;
  throw py::type_error("expected a system, as minamo.system makes them, got " + py::repr(system).cast<std::string>());
}

}  // namespace

PythonSystem::PythonSystem(const py::handle& system)
    : name(require_system(system).attr("name").cast<std::string>()),
      slot(system.attr("slot").cast<std::string>()),
      standing(system.attr("standing").cast<bool>()),
      function(system.attr("function")) {
  const std::pair<const char*, Mode> modes[] = {
      {"reads", Mode::read}, {"writes", Mode::write}, {"updates", Mode::update}};
  for (const auto& [key, mode] : modes) {
    for (const py::handle& component : system.attr(key)) {
      if (py::isinstance<DescribedColumn>(component)) {
        const auto described = component.cast<std::shared_ptr<DescribedColumn>>();
        declared.push_back({mode, std::string(described->info().name), described});
      } else {
        declared.push_back({mode, component.cast<std::string>(), nullptr});
      }
    }
  }
}

PythonSystem::~PythonSystem() {
  const py::gil_scoped_acquire lock;
  function = py::object();
}

namespace {

std::string key_of(Mode mode) { return mode == Mode::read ? "reads" : mode == Mode::write ? "writes" : "updates"; }

Problem unknown_name(const std::string& file, const std::string& pointer, const std::string& what,
                     const std::string& name, const std::vector<std::string>& known) {
  return {file, pointer, what, one_of_text(known), shown(Json(name)), closest_name(name, known)};
}

std::optional<Problem> problem_of(const std::string& file, const Declared& declared, const KnownComponents& known) {
  const std::string key = key_of(declared.mode);
  if (declared.described) {
    if (known.find(declared.component)) {
      return Problem{file,
                     key,
                     "a column of one's own has the name of a component of the program",
                     "another name, or that name as a text",
                     shown(Json(declared.component)),
                     {}};
    }
    const std::string table = declared.described->table();
    if (!known.table(table).empty()) return {};
    return unknown_name(file, key, "column of an unknown table", table, known.tables());
  }
  const Access* access = known.find(declared.component);
  if (!access) return unknown_name(file, key, "unknown component", declared.component, known.names());
  if (access->table.empty() && !is_resource_for_python(declared.component)) {
    return Problem{file,
                   key,
                   "is no column",
                   fmt::format("a column, \"{}\" or \"{}\"", clock_name, history_name),
                   shown(Json(declared.component)),
                   {}};
  }
  const bool is_wrong_mode = (declared.component == clock_name && declared.mode != Mode::read) ||
                             (declared.component == history_name && declared.mode != Mode::update);
  if (!is_wrong_mode) return {};
  return Problem{file,
                 key,
                 "wrong access",
                 declared.component == clock_name ? "reads" : "updates",
                 shown(Json(declared.component)),
                 {}};
}

}  // namespace

std::vector<Problem> problems_of(const PythonSystem& system, const KnownComponents& known) {
  std::vector<Problem> problems;
  std::vector<std::string> names;
  for (const Slot& slot : slots()) names.emplace_back(slot.name);
  if (std::find(names.begin(), names.end(), system.slot) == names.end())
    problems.push_back(unknown_name(place_of(system), "slot", "unknown slot", system.slot, names));
  for (const Declared& declared : system.declared) {
    if (const auto problem = problem_of(place_of(system), declared, known)) problems.push_back(*problem);
  }
  return problems;
}

std::vector<Problem> missing_components(const PythonSystem& system, const World& world) {
  std::vector<Problem> problems;
  std::vector<std::string> columns;
  for (const auto& [name, storage] : world.components()) {
    if (storage->layout().number != ValueLayout::Number::none) columns.push_back(name);
  }
  for (const Declared& declared : system.declared) {
    const auto found = world.components().find(declared.component);
    const bool is_there = found != world.components().end();
    if (is_there && is_resource_for_python(declared.component)) continue;
    const auto number = is_there ? found->second->layout().number : ValueLayout::Number::none;
    const bool is_column = number != ValueLayout::Number::none;
    if (number == ValueLayout::Number::real || (is_column && declared.mode == Mode::read)) continue;
    if (is_column) {
      // Whole numbers are places in memory.
      problems.push_back({place_of(system),
                          key_of(declared.mode),
                          "can be read, not written",
                          "a column of real numbers",
                          shown(Json(declared.component)),
                          {}});
      continue;
    }
    Problem problem = unknown_name(place_of(system), key_of(declared.mode),
                                   is_there ? "its values are not made of numbers" : "no system of this scene names it",
                                   declared.component, columns);
    if (problem.closest == declared.component) problem.closest.clear();
    problems.push_back(std::move(problem));
  }
  return problems;
}

}  // namespace minamo::python
