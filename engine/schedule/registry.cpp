#include "engine/schedule/registry.hpp"

namespace minamo {

System SystemRegistry::Entry::make(int dimension, Input* options) const {
  const Kernel& kernel = dimension == 2 ? plane : space;
  return detail::make_system(name, *kernel.system, kernel.make ? kernel.make(options) : nullptr);
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

void SystemRegistry::insert(std::string_view name, std::string_view doc, const Entry::Kernel& plane,
                            const Entry::Kernel& space) {
  const bool is_new =
      entries_.try_emplace(std::string(name), Entry{std::string(name), std::string(doc), plane, space}).second;
  if (!is_new) throw std::logic_error("system \"" + std::string(name) + "\" is registered twice");
}

}  // namespace minamo
