#pragma once
/// \file
/// Words of other programs, and what a document calls them: hints by meaning, where closest_name() knows letters alone.
/// The words themselves are no matter of the engine; who reads a document hands them over (Input::use_words).

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace minamo {

struct OtherWord {
  enum class Of {
    key,        ///< of an object
    name,       ///< a text that is one of a few names
    expression  ///< a name or an operator in an expression
  };
  Of of = Of::key;
  std::string_view word;
  /// What it is here. Of a key: the key of the same object, or a pointer, whose last step is that key; `*` stands for
  /// an element of a list.
  std::string_view means;
  std::string_view expected = {};  ///< what the value is here, where it is written in another way
};

/// Whether two words are the same but for case and for `_`, `-`, `.` and spaces: timeStep, time_step, "Time step".
bool are_same_word(std::string_view a, std::string_view b);

/// What a name means, one of those that are known; empty if nothing.
std::string meant_name(std::span<const OtherWord> words, std::string_view name, std::span<const std::string> known);

/// What the first word of an expression means that is no known name; empty if there is none. \pre it does not parse
std::string meant_in_expression(std::span<const OtherWord> words, std::string_view text,
                                std::span<const std::string> known);

}  // namespace minamo
