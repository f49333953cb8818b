#include "engine/input/text_mistakes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace minamo {

namespace {

constexpr std::string_view white_space = " \t\r\n";

bool is_of_words(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_a_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The word around a place; empty if there is none.
std::string_view word_around(std::string_view text, std::size_t at) {
  std::size_t begin = at;
  while (begin > 0 && is_of_words(text[begin - 1])) --begin;
  std::size_t end = at;
  while (end < text.size() && is_of_words(text[end])) ++end;
  return text.substr(begin, end - begin);
}

/// The last character before a place that is not white_space.
std::size_t last_before(std::string_view text, std::size_t at) {
  return at == 0 ? std::string_view::npos : text.find_last_not_of(white_space, at - 1);
}

/// Whether a number ends before a place.
bool is_after_number(std::string_view text, std::size_t at) {
  const std::size_t last = last_before(text, at);
  return last != std::string_view::npos && is_a_digit(text[last]);
}

std::size_t line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Words that other notations have in the place of a number, true, false or null.
std::optional<TextMistake> value_of_word(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "nan") return TextMistake{"NaN, which is no number of JSON", "a finite number"};
  if (lower == "inf" || lower == "infinity")
    return TextMistake{fmt::format("{}, which is no number of JSON", word), "a finite number"};
  for (const std::string_view literal : {"true", "false", "null"}) {
    if (lower == literal) return TextMistake{fmt::format("{} in another spelling", word), std::string(literal)};
  }
  if (lower == "none") return TextMistake{"None", "no key at all, or \"none\" in quotes"};
  return {};
}

std::optional<TextMistake> mistake_of_word(std::string_view text, std::size_t at) {
  constexpr std::size_t longest = 40;  // as a message quotes it
  const std::string_view word = word_around(text, at);
  if (word.empty() || word.size() > longest) return {};
  const auto begin = static_cast<std::size_t>(word.data() - text.data());
  if (is_a_digit(word.front()) || is_after_number(text, begin))
    return TextMistake{"letters after a number", "the number alone, or an expression in quotes"};
  const std::size_t after = text.find_first_not_of(white_space, begin + word.size());
  if (after != std::string_view::npos && text[after] == ':')
    return TextMistake{"a key without quotes", fmt::format("\"{}\"", word)};
  if (auto value = value_of_word(word)) return value;
  return TextMistake{"a word without quotes", fmt::format("\"{}\"", word)};
}

std::optional<TextMistake> mistake_of_comma(std::string_view text, std::size_t at) {
  const std::size_t comma = last_before(text, at);
  if (comma == std::string_view::npos || text[comma] != ',') return {};
  return TextMistake{
      fmt::format("a comma before '{}'", text[at]),
      fmt::format("none after the last {}, in line {}", text[at] == '}' ? "key" : "element", line_of(text, comma))};
}

}  // namespace

std::optional<TextMistake> mistake_at(std::string_view text, std::size_t at) {
  if (at >= text.size()) return {};
  const char c = text[at];
  const char next = at + 1 < text.size() ? text[at + 1] : ' ';
  const bool is_comment = c == '#' || (c == '/' && (next == '/' || next == '*'));
  if (is_comment) return TextMistake{"a comment, which JSON does not have", "the text without it"};
  if (c == '}' || c == ']') return mistake_of_comma(text, at);
  if (c == '\'') return TextMistake{"a single quote", "double quotes around keys and texts"};
  if (c == '.' && is_a_digit(next)) return TextMistake{"a number that begins with its point", "a digit before it: 0.5"};
  if (c == '+' && (is_a_digit(next) || next == '.')) return TextMistake{"a number with a plus sign", "none: 0.5"};
  if (is_after_number(text, at) && std::string_view("*/^+").find(c) != std::string_view::npos)
    return TextMistake{"an expression without quotes", "one in quotes, like \"2*pi/3\""};
  return is_of_words(c) ? mistake_of_word(text, at) : std::nullopt;
}

std::optional<TextMistake> mistake_of_encoding(std::string_view text) {
  using namespace std::string_view_literals;
  struct Mark {
    std::string_view bytes;
    std::string_view encoding;
  };
  // That of UTF-32 begins with that of UTF-16. What begins with a brace and a zero has no mark, and the same zeros.
  static constexpr std::array marks{Mark{"\xff\xfe\0\0"sv, "UTF-32"}, Mark{"\0\0\xfe\xff"sv, "UTF-32"},
                                    Mark{"\xff\xfe"sv, "UTF-16"},     Mark{"\xfe\xff"sv, "UTF-16"},
                                    Mark{"{\0\0\0"sv, "UTF-32"},      Mark{"\0\0\0{"sv, "UTF-32"},
                                    Mark{"{\0"sv, "UTF-16"},          Mark{"\0{"sv, "UTF-16"}};
  for (const Mark& mark : marks) {
    if (!text.starts_with(mark.bytes)) continue;
    return TextMistake{fmt::format("is a text in {}", mark.encoding),
                       fmt::format("one in UTF-8: save it as such, or `iconv -f {} -t UTF-8 FILE`", mark.encoding)};
  }
  return {};
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

}  // namespace minamo
