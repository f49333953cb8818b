#pragma once
/// \file
/// What is wrong with an input: where, what, expected, got, closest. Not the reading that finds it (input.hpp).

#include <nlohmann/json.hpp>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace minamo {

/// JSON whose keys keep their order.
using Json = nlohmann::ordered_json;

/// One thing wrong with an input, in the voice of every message:
///     dam_break.json: /transfer/scheme: unknown name
///       expected  one of ["apic", "flip", "pic", "tpic", "xpic"]
///       got       "apci" (string)
///       closest   "apic"
struct Problem {
  std::string file;          ///< as the user has named it
  std::string pointer;       ///< JSON pointer; empty where the document as a whole is meant
  std::string what;          ///< what is wrong, in a few words
  std::string expected;      ///< this and the next two may be empty
  std::string got;           ///< what stands there, as shown() has it
  std::string closest;       ///< a name, which text() quotes, or a JSON value, which it leaves
  std::string text() const;  ///< the message, without a line end
};

/// An input is wrong; it has every problem of it. The program prints them and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);                 ///< what(): all texts, one after the other
  const std::vector<Problem>& problems() const { return problems_; }  ///< all of them

 private:
  std::vector<Problem> problems_;
};

/// The known name nearest to `name` by edit distance, case aside; empty if none is near.
std::string closest_name(std::string_view name, std::span<const std::string> known);

/// A JSON value as the messages show it: `"apci" (string)`, `-3 (number)`, long ones cut.
std::string shown(const Json& value);

/// Names as the messages list them: `["apic", "flip"]`.
std::string listed(std::span<const std::string> names);

/// `one of ["apic", "flip"]`; `a known name` where the list would fill the screen.
std::string one_of_text(std::span<const std::string> names);

/// A key as a step of a JSON pointer: `~` and `/` escaped.
std::string pointer_token(std::string_view key);

}  // namespace minamo
