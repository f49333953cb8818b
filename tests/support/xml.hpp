#pragma once
/// \file
/// Whether a text is XML that every reader takes, as far as our own files go: elements, attributes without `>`,
/// processing instructions.

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace minamo {

inline bool is_well_formed(std::string_view text) {
  std::vector<std::string_view> open;
  int roots = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '<') {
      // Between elements of ours there is text only within one.
      if (open.empty() && std::isspace(static_cast<unsigned char>(text[at])) == 0) return false;
      ++at;
      continue;
    }
    const bool is_instruction = text.substr(at, 2) == "<?";
    const auto end = text.find(is_instruction ? "?>" : ">", at);
    if (end == std::string_view::npos) return false;
    if (is_instruction) {
      at = end + 2;
      continue;
    }
    const std::string_view tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
      continue;
    }
    if (open.empty()) ++roots;
    if (!tag.ends_with('/')) open.push_back(tag.substr(0, tag.find_first_of(" \n")));
  }
  return open.empty() && roots == 1;
}

}  // namespace minamo
