#pragma once
/// \file
/// What a text may have been meant as that is no JSON: the usual slips of a hand, and encodings other than UTF-8.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace minamo {

struct TextMistake {
  std::string what;
  std::string expected;
};

/// What is at a place where a text stops being JSON, if it is known: a comment, a comma after the last element, NaN,
/// True, a word without quotes, ...
/// \param at  of the first character that cannot be
std::optional<TextMistake> mistake_at(std::string_view text, std::size_t at);

/// Where the text is none in UTF-8 by its first bytes: UTF-16 or UTF-32, with byte order mark or without.
std::optional<TextMistake> mistake_of_encoding(std::string_view text);

/// The text without the mark that editors put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace minamo
