#include "engine/input/other_words.hpp"

#include <algorithm>
#include <cctype>

namespace minamo {

namespace {

bool is_written(char c) { return c != '_' && c != '-' && c != '.' && c != ' '; }

char in_lower_case(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

bool is_of_names(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; }

bool is_of_operators(char c) { return std::string_view("*&|=<>!%").find(c) != std::string_view::npos; }

/// The piece of an expression that begins at a place: a name, an operator, or a single character.
std::string_view piece_at(std::string_view text, std::size_t at) {
  const auto rest = text.substr(at);
  const auto length_of = [&](auto belongs) {
    return static_cast<std::size_t>(std::find_if_not(rest.begin(), rest.end(), belongs) - rest.begin());
  };
  return rest.substr(0, std::max<std::size_t>({1, length_of(is_of_names), length_of(is_of_operators)}));
}

}  // namespace

bool are_same_word(std::string_view a, std::string_view b) {
  auto x = a.begin();
  auto y = b.begin();
  for (;;) {
    x = std::find_if(x, a.end(), is_written);
    y = std::find_if(y, b.end(), is_written);
    if (x == a.end() || y == b.end()) return x == a.end() && y == b.end();
    if (in_lower_case(*x++) != in_lower_case(*y++)) return false;
  }
}

std::string meant_name(std::span<const OtherWord> words, std::string_view name, std::span<const std::string> known) {
  for (const OtherWord& other : words) {
    if (other.of != OtherWord::Of::name || !are_same_word(other.word, name)) continue;
    if (std::find(known.begin(), known.end(), other.means) != known.end()) return std::string(other.means);
  }
  return {};
}

std::string meant_in_expression(std::span<const OtherWord> words, std::string_view text,
                                std::span<const std::string> known) {
  const auto is_known = [&](std::string_view name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  // What is not a name can be written with names that are always there.
  const auto can_be_written = [&](std::string_view means) {
    return !std::all_of(means.begin(), means.end(), is_of_names) || is_known(means);
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view piece = piece_at(text, at);
    at += piece.size();
    if (is_known(piece)) continue;
    const auto found = std::find_if(words.begin(), words.end(), [&](const OtherWord& other) {
      return other.of == OtherWord::Of::expression && other.word == piece && can_be_written(other.means);
    });
    if (found != words.end()) return std::string(found->means);
  }
  return {};
}

}  // namespace minamo
