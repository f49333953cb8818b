#include "engine/input/problem.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <numeric>

namespace minamo {

namespace {

std::string joined(const std::vector<Problem>& problems) {
  std::string all;
  for (const Problem& problem : problems) {
    if (!all.empty()) all += '\n';
    all += problem.text();
  }
  return all;
}

std::string lower_case(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn one string into the other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

std::string quoted(const std::string& name) { return Json(name).dump(-1, ' ', false, Json::error_handler_t::replace); }

/// In valid UTF-8 and on one line, without what would steer a terminal: names and lines come from the input.
std::string printable(const std::string& text) {
  const auto valid = Json::parse(quoted(text)).get<std::string>();
  std::string shown;
  for (const char c : valid) {
    const auto code = static_cast<unsigned char>(c);
    shown += code < 0x20 || code == 0x7f ? fmt::format("\\u{:04x}", code) : std::string(1, c);
  }
  return shown;
}

/// Cut after at most `length` bytes, not within a UTF-8 character.
std::string cut(std::string text, std::size_t length) {
  if (text.size() <= length) return text;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return text.substr(0, length) + "...";
}

}  // namespace

std::string Problem::text() const {
  std::string text;
  for (const std::string* place : {&file, &pointer})
    if (!place->empty()) text += printable(*place) + ": ";
  text += printable(what);
  if (!expected.empty()) text += "\n  expected  " + printable(expected);
  if (!got.empty()) text += "\n  got       " + printable(got);
  if (closest.empty()) return text;
  return text.append("\n  closest   ").append(printable(Json::accept(closest) ? closest : quoted(closest)));
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

std::string closest_name(std::string_view name, std::span<const std::string> known) {
  const std::string wanted = lower_case(name);
  std::string closest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : known) {
    const std::size_t length = std::max(wanted.size(), candidate.size());
    const std::size_t most = std::max<std::size_t>(1, 2 * length / 5);
    if (length - std::min(wanted.size(), candidate.size()) > most) continue;  // so many letters are wrong at least
    const std::size_t distance = edit_distance(wanted, lower_case(candidate));
    // Two letters of five may be wrong, but not all: "x" is not near "y".
    const bool near = distance <= most && distance < length;
    if (near && distance < least) {
      least = distance;
      closest = candidate;
    }
  }
  return closest;
}

std::string shown(const Json& value) {
  if (value.is_null()) return "null";
  const std::string text = cut(value.dump(-1, ' ', false, Json::error_handler_t::replace), 60);
  if (value.is_object()) return text + " (object)";
  if (value.is_array()) return text + " (list)";
  if (value.is_string()) return text + " (string)";
  if (value.is_boolean()) return text + " (boolean)";
  return text + " (number)";
}

std::string listed(std::span<const std::string> names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + quoted(name);
  return "[" + list + "]";
}

std::string one_of_text(std::span<const std::string> names) {
  constexpr std::size_t screenful = 30;  // the keys at the top of a scene are 26
  return names.size() > screenful ? "a known name" : fmt::format("one of {}", listed(names));
}

std::string pointer_token(std::string_view key) {
  std::string token;
  for (const char c : key) token += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
  return token;
}

}  // namespace minamo
