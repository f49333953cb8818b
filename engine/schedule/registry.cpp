#include "engine/schedule/registry.hpp"

namespace minamo {

System SystemRegistry::Entry::make(int dimension, Input* options) const {
  const Kernel& kernel = dimension == 2 ? plane : space;
  System system = detail::make_system(name, *kernel.system, kernel.make ? kernel.make(options) : nullptr);
  system.on_ranks = on_ranks;
  return system;
}

System SystemRegistry::make(std::string_view name, int dimension, Input* options) const {
  const auto found = entries_.find(name);
  if (found != entries_.end()) return found->second.make(dimension, options);

  const std::vector<std::string> known = names();
  Problem problem{{}, {}, "unknown system", {}, shown(Json(name)), closest_name(name, known)};
  problem.expected.append("one of ").append(Json(known).dump());
  throw std::out_of_range(problem.text());
}

std::vector<std::string> SystemRegistry::names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

void SystemRegistry::insert(Entry entry) {
  const auto [position, is_new] = entries_.try_emplace(entry.name, entry);
  if (!is_new) throw std::logic_error("system \"" + position->first + "\" is registered twice");
}

std::string SystemRegistry::file_of(const Doc& doc) {
  constexpr std::string_view folder = "/systems/";
  const std::size_t at = doc.file.rfind(folder);
  return at == std::string_view::npos ? std::string() : std::string(doc.file.substr(at + 1));
}

}  // namespace minamo
