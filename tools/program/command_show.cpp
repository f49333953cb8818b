#include "tools/program/commands.hpp"

#include "engine/schedule/schedule.hpp"
#include "systems/step/exclusions.hpp"
#include "systems/step/step_table.hpp"
#include "tools/program/scene_file.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <iostream>
#include <set>

namespace minamo {

int check_scenes(const std::vector<std::string>& scenes, const SystemRegistry& registry) {
  bool valid = true;
  for (const std::string& path : scenes) {
    try {
      const SceneFile file = load_scene(path, {}, registry);
      const Rehearsal rehearsal = rehearse(file.scene, path);
      std::cout << path << ": valid, " << rehearsal.particles << " particles\n"
                << text_of(rehearsal.outlook, file.scene) << std::flush;
      for (const std::string& warning : rehearsal.warnings) spdlog::warn("{}: {}", path, warning);
    } catch (const InputError& error) {
      std::cerr << error.what() << '\n';
      valid = false;
    } catch (const ScheduleError& error) {
      std::cerr << path << ": " << error.what() << '\n';
      valid = false;
    }
  }
  return valid ? exit_done : exit_bad_input;
}

namespace {

/// What the step of the scene does: state that may be there and that no system of the step writes is not.
std::vector<System> shown_step(const Scene& scene) {
  std::vector<System> step = without_absent(make_pipeline(scene).step);
  std::set<std::string_view> written;
  for (const System& system : step) {
    for (const Access& access : system.access) {
      if (access.mode == Mode::write || access.mode == Mode::update) written.insert(access.component);
    }
  }
  for (System& system : step) {
    std::erase_if(system.access,
                  [&](const Access& access) { return access.optional && !written.contains(access.component); });
  }
  return step;
}

}  // namespace

int show_graph(const std::string& scene, const std::string& format, const SystemRegistry& registry) {
  const SceneFile file = load_scene(scene, {}, registry);
  const std::string title = file.scene.title.empty() ? scene : file.scene.title;
  const std::vector<System> step = shown_step(file.scene);
  std::cout << (format == "dot" ? to_dot(step, title) : to_json(step, title)) << '\n';
  return exit_done;
}

namespace {

/// What a system reads and writes, as the catalogue shows it.
std::string accesses(const System& system, bool writes) {
  std::string names;
  for (const Access& access : system.access) {
    const bool is_write = access.mode != Mode::read;
    const bool is_read = access.mode == Mode::read || access.mode == Mode::update;
    if (writes ? !is_write : !is_read) continue;
    if (!names.empty()) names += ", ";
    names += is_of_table(access.mode) ? fmt::format("rows of {}", access.table) : std::string(access.component);
    if (access.optional) names += " (if there is one)";
  }
  return names;
}

/// As a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

/// With a link from the folder of all systems to the file that declares it.
std::string linked(const SystemRegistry::Entry& system) {
  constexpr std::string_view folder = "systems/";
  return system.file.empty() ? system.name : fmt::format("[{}]({})", system.name, system.file.substr(folder.size()));
}

void list_systems(const SystemRegistry& registry) {
  std::cout << "| system | does | reads | writes | on ranks |\n|---|---|---|---|---|\n";
  for (const auto& [name, entry] : registry.entries()) {
    const System system = entry.make(2, nullptr);
    std::cout << fmt::format("| {} | {} | {} | {} | {} |\n", linked(entry), entry.doc, accesses(system, false),
                             accesses(system, true), name_of(entry.on_ranks));
  }
}

std::string words_of(const std::vector<Condition>& all) {
  std::string words;
  for (const Condition& one : all) words.append(words.empty() ? "" : ", ").append(one.words);
  return words;
}

std::string_view name_of(When when) {
  switch (when) {
  case When::always:
    return "both";
  case When::step:
    return "step";
  case When::standing:
    return "start";
  }
  return {};
}

/// The tables of the step of both methods.
void list_step(const SystemRegistry& registry) {
  for (const auto& [method, table] :
       {std::pair{"conforming", &table_of_faces()}, std::pair{"equal_order", &table_of_equal_order()}}) {
    std::cout << fmt::format("\n{}\n\n| slot | system | in | if | on ranks |\n|---|---|---|---|---|\n", method);
    std::string_view slot;
    for (const Row& row : table->rows) {
      const auto entry = registry.entries().find(row.system);
      std::cout << fmt::format("| {} | `{}` | {} | {} | {} |\n", row.slot == slot ? "" : row.slot, row.system,
                               name_of(row.when), words_of(row.all),
                               entry == registry.entries().end() ? "" : name_of(entry->second.on_ranks));
      slot = row.slot;
    }
  }
}

void list_exclusions() {
  std::cout << "| key | has | not with | because |\n|---|---|---|---|\n";
  for (const Exclusion& row : exclusions())
    std::cout << fmt::format("| {} | {} | {} | {} |\n", row.key, row.has.words, row.with.words, row.why);
}

void list_components(const SystemRegistry& registry) {
  std::map<std::string_view, const ComponentInfo*> components;
  for (const auto& [name, entry] : registry.entries()) {
    for (const Access& access : entry.make(2, nullptr).access) {
      if (access.info) components.emplace(access.component, access.info);
    }
  }
  std::cout << "| component | symbol | unit | lifetime |\n|---|---|---|---|\n";
  for (const auto& [name, info] : components) {
    std::cout << fmt::format("| {} | {} | {} | {} |\n", name, cell(info->symbol), info->unit, name_of(info->lifetime));
  }
}

void list_parts(const SystemRegistry& registry) {
  for (const Part& part : registry.in_order<Part>()) {
    std::string schemes;
    if (part.schemes) {
      for (const auto& [name, doc] : part.schemes(registry)) schemes += (schemes.empty() ? ": " : ", ") + name;
    }
    std::cout << fmt::format("{:14} {}{}\n", part.name, part.doc, schemes);
  }
}

/// Those of one part, or of all.
void list_schemes(const SystemRegistry& registry, std::string_view of_part) {
  for (const Part& part : registry.in_order<Part>()) {
    if (!part.schemes || (!of_part.empty() && part.name != of_part)) continue;
    for (const auto& [name, doc] : part.schemes(registry)) {
      std::cout << fmt::format("{:10} {} ({})\n", name, doc, part.name);
    }
  }
}

}  // namespace

int list(const std::string& what, const SystemRegistry& registry) {
  if (what == "systems") {
    list_systems(registry);
  } else if (what == "step") {
    list_step(registry);
  } else if (what == "exclusions") {
    list_exclusions();
  } else if (what == "components") {
    list_components(registry);
  } else if (what == "parts") {
    list_parts(registry);
  } else {
    list_schemes(registry, what == "solvers" ? "solver" : "");
  }
  return exit_done;
}

int show_schema(bool as_table, const SystemRegistry& registry) {
  Input::Document document = Input::Document::describe();
  describe_scene(document.root(), registry);
  if (as_table) {
    std::cout << document.key_table();
  } else {
    std::cout << document.schema().dump(2) << '\n';
  }
  return exit_done;
}

}  // namespace minamo
