#include "listings.hpp"

#include "part.hpp"

#include "engine/schedule/schedule.hpp"
#include "systems/step/register.hpp"

#include <algorithm>

namespace minamo::python {

namespace {

SystemRegistry registered() {
  SystemRegistry registry;
  register_parts(registry);
  return registry;
}

py::list names_of(const System& system, bool (*counts)(Mode)) {
  py::list names;
  for (const Access& access : system.access) {
    if (!counts(access.mode)) continue;
    names.append(is_of_table(access.mode) ? "rows of " + std::string(access.table) : std::string(access.component));
  }
  return names;
}

py::list systems_of(const SystemRegistry& registry) {
  py::list systems;
  for (const auto& [name, entry] : registry.entries()) {
    const System system = entry.make(2, nullptr);
    py::dict described;
    described["name"] = name;
    described["doc"] = entry.doc;
    described["file"] = entry.file;
    described["reads"] = names_of(system, [](Mode mode) { return mode == Mode::read || mode == Mode::update; });
    described["writes"] = names_of(system, [](Mode mode) { return mode != Mode::read; });
    systems.append(described);
  }
  return systems;
}

py::list components_of(const SystemRegistry& registry) {
  py::list components;
  const KnownComponents known(registry, 2);
  for (const std::string& name : known.names()) {
    const Access& access = *known.find(name);
    py::dict described;
    described["name"] = name;
    described["table"] = std::string(access.table);
    described["symbol"] = std::string(access.info->symbol);
    described["unit"] = std::string(access.info->unit);
    described["lifetime"] = std::string(name_of(access.info->lifetime));
    components.append(described);
  }
  return components;
}

py::list parts_of(const SystemRegistry& registry) {
  py::list parts;
  for (const Part& part : registry.in_order<Part>()) {
    py::list schemes;
    if (part.schemes) {
      for (const auto& [name, doc] : part.schemes(registry)) schemes.append(name);
    }
    py::dict described;
    described["name"] = part.name;
    described["doc"] = part.doc;
    described["schemes"] = schemes;
    parts.append(described);
  }
  return parts;
}

py::list schemes_of_part(const SystemRegistry& registry, const std::string& of_part) {
  py::list schemes;
  for (const Part& part : registry.in_order<Part>()) {
    if (!part.schemes || (!of_part.empty() && part.name != of_part)) continue;
    for (const auto& [name, doc] : part.schemes(registry)) {
      py::dict described;
      described["name"] = name;
      described["doc"] = doc;
      described["part"] = part.name;
      schemes.append(described);
    }
  }
  return schemes;
}

}  // namespace

py::list list(const std::string& what) {
  const SystemRegistry registry = registered();
  if (what == "systems") return systems_of(registry);
  if (what == "components") return components_of(registry);
  if (what == "parts") return parts_of(registry);
  if (what == "schemes") return schemes_of_part(registry, {});
  if (what == "solvers") return schemes_of_part(registry, "solver");
  const std::vector<std::string> known{"parts", "schemes", "solvers", "systems", "components"};
  throw InputError({{"list", {}, "unknown name", one_of_text(known), shown(Json(what)), closest_name(what, known)}});
}

py::list check(const std::optional<std::string>& text, const std::string& name, const py::iterable& systems,
               const py::iterable& parts) {
  py::list problems;
  try {
    const PreparedScene scene = prepare_scene(text, name, systems, parts);
    rehearse(scene.file.scene, name);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) problems.append(as_tuple(problem));
  } catch (const ScheduleError& error) {
    problems.append(as_tuple({name, {}, error.what(), {}, {}, {}}));
  }
  return problems;
}

std::string schema() {
  const SystemRegistry registry = registered();
  Input::Document document = Input::Document::describe();
  describe_scene(document.root(), registry);
  return document.schema().dump();
}

}  // namespace minamo::python
