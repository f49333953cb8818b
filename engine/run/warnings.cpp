#include "engine/run/warnings.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace minamo {

void Warnings::add(std::string_view kind, std::string text) {
  if (has(kind)) return;
  spdlog::warn("{}", text);
  entries_.push_back({std::string(kind), std::move(text)});
}

bool Warnings::has(std::string_view kind) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.kind == kind; });
}

std::vector<std::string> Warnings::texts() const {
  std::vector<std::string> texts;
  for (const Entry& entry : entries_) texts.push_back(entry.text);
  return texts;
}

}  // namespace minamo
