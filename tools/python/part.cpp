#include "part.hpp"

#include "engine/schedule/schedule.hpp"
#include "systems/step/register.hpp"
#include "systems/step/scene_systems.hpp"

#include <set>

namespace minamo::python {

namespace {

/// The text of a python string, never freed: rules of the input refer to it, and registries keep these.
std::string_view kept(const py::handle& text) { return *new std::string(text.cast<std::string>()); }

/// An option of a part, from minamo.Number.
struct Option {
  std::string name;
  Number rule;
};

std::optional<double> optional_number(const py::handle& value) { return value.cast<std::optional<double>>(); }

std::vector<Option> options_of(const py::handle& part) {
  std::vector<Option> options;
  for (const auto& [name, number] : part.attr("options").cast<py::dict>()) {
    Option option{name.cast<std::string>(), {.unit = kept(number.attr("unit")), .doc = kept(number.attr("doc"))}};
    option.rule.fallback = optional_number(number.attr("default"));
    if (const auto least = optional_number(number.attr("at_least"))) option.rule.at_least = *least;
    if (const auto most = optional_number(number.attr("at_most"))) option.rule.at_most = *most;
    options.push_back(std::move(option));
  }
  return options;
}

/// The systems that the parts of a scene have made, in the order of the parts.
using Made = std::vector<std::shared_ptr<const PythonSystem>>;

/// \throws InputError if a part of the program, or another one, has the name
void require_free(const SystemRegistry& registry, const std::string& part) {
  for (const Part& known : registry.in_order<Part>()) {
    if (known.name == part)
      throw InputError({{"part \"" + part + "\"", {}, "there is one of that name", "another name", {}, {}}});
  }
}

/// A slot has a system once: one of a name that is taken would not be there.
std::vector<Problem> repeated_names(const PreparedScene& prepared) {
  std::vector<Problem> problems;
  std::set<std::string> names;
  for (const auto& system : prepared.systems) {
    const bool is_taken = prepared.registry->contains(system->name) || !names.insert(system->name).second;
    if (is_taken)
      problems.push_back({"system \"" + system->name + "\"", {}, "there is one of that name", "another name", {}, {}});
  }
  return problems;
}

/// A scene without the key has nothing of the part.
void add_part(SystemRegistry& registry, const py::object& part, const std::shared_ptr<Made>& made) {
  const auto name = part.attr("name").cast<std::string>();
  const auto doc = part.attr("doc").cast<std::string>();
  require_free(registry, name);
  const auto read = [part, name, doc, made, options = options_of(part)](Input& input, Scene&) {
    py::dict values;
    bool is_there = false;
    input.object(name, doc, Input::Presence::only_if_present, [&](Input& in) {
      is_there = true;
      for (const Option& option : options) values[py::str(option.name)] = in.number(option.name, option.rule);
    });
    if (!is_there || input.describing()) return Contribution{};
    return Contribution([part, values, made](const Scene&, Recipe&) {
      for (const py::handle& system : part.attr("systems")(**values)) {
        made->push_back(std::make_shared<PythonSystem>(system));
      }
    });
  };
  registry.add(Part{name, doc, read, {}});
}

/// Where each could stand is found as for the extra systems of a scene.
std::vector<Problem> misplaced(const Scene& scene, const std::vector<System>& made, const PreparedScene& prepared) {
  Scene with = scene;
  with.systems.clear();
  for (std::size_t k = 0; k < made.size(); ++k) with.systems.push_back({made[k], prepared.systems[k]->slot});
  std::vector<Problem> problems = misplaced_systems(with, prepared.name);
  for (Problem& problem : problems) {
    const std::size_t k = std::stoul(problem.pointer.substr(std::string("/systems/").size()));
    problem.file = "system \"" + made[k].name + "\"";
    problem.pointer = "slot";
  }
  return problems;
}

}  // namespace

PreparedScene prepare_scene(const std::optional<std::string>& text, const std::string& name,
                            const py::iterable& systems, const py::iterable& parts) {
  PreparedScene prepared{std::make_shared<SystemRegistry>(), {}, name, {}, std::make_shared<Failures>()};
  register_parts(*prepared.registry);
  const auto made_by_parts = std::make_shared<Made>();
  for (const py::handle& part : parts)
    add_part(*prepared.registry, py::reinterpret_borrow<py::object>(part), made_by_parts);
  prepared.file = text ? understand_scene(parse_json(*text, name), name, *prepared.registry)
                       : load_scene(name, {}, *prepared.registry);
  prepared.systems = *made_by_parts;
  for (const py::handle& system : systems) prepared.systems.push_back(std::make_shared<PythonSystem>(system));
  if (prepared.systems.empty()) return prepared;

  Scene& scene = prepared.file.scene;
  const KnownComponents known(*prepared.registry, scene.dimension);
  std::vector<Problem> problems = repeated_names(prepared);
  for (const auto& system : prepared.systems) {
    const std::vector<Problem> more = problems_of(*system, known);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  std::vector<System> made;
  for (const auto& system : prepared.systems)
    made.push_back(make_system(system, known, scene.dimension, prepared.failures));
  if (problems = misplaced(scene, made, prepared); !problems.empty()) throw InputError(std::move(problems));
  for (std::size_t k = 0; k < made.size(); ++k) {
    scene.recipe.add(prepared.systems[k]->slot, made[k], prepared.systems[k]->standing ? When::always : When::step);
  }
  return prepared;
}

void require_components(const PreparedScene& scene, const World& world) {
  std::vector<Problem> problems;
  for (const auto& system : scene.systems) {
    const std::vector<Problem> more = missing_components(*system, world);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace minamo::python
