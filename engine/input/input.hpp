#pragma once
/// \file
/// Reading a JSON document strictly: every key is read through one call that states its type, unit, default and range.
/// From these calls come the values, all problems at once, the document as understood (defaults filled in), and the
/// JSON Schema and key table. There is no second list of keys anywhere.

#include "engine/input/expression.hpp"
#include "engine/input/input_rule.hpp"
#include "engine/input/input_text.hpp"
#include "engine/input/other_words.hpp"
#include "engine/input/problem.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace minamo {

struct InputPlace;
struct InputRecord;

/// A place in the document: an object (or the element of a list) with its pointer.
/// Reading never throws on bad content: it notes the problem and returns a harmless value, so that all are found.
/// In description mode there is no document; every call returns its default or a value that fits, every object and
/// variant is visited, and list callbacks are called once. Reading a key again with another size accepts both sizes.
class Input {
 public:
  /// The whole document; `document` must outlive it.
  class Document;

  /// From here on a string in the place of a number, or of a whole number, is an expression in these constants. What it
  /// comes to is what is echoed.
  void use_constants(const std::map<std::string, double>& constants);
  /// From here on messages know these words of other programs. \pre they outlive the document
  void use_words(std::span<const OtherWord> words);

  /// A number within the rule, like `in.number("rate", {.unit = "1/s", .doc = "share lost", .at_least = 0})`.
  double number(std::string_view key, const Number& rule);
  /// Like number(), for a key that may be absent without a default.
  std::optional<double> optional_number(std::string_view key, const Number& rule);
  /// A whole number.
  std::int64_t integer(std::string_view key, const Integer& rule);
  /// A string.
  std::string text(std::string_view key, const Text& rule);
  /// Like text(), for a key that may be absent without a default.
  std::optional<std::string> optional_text(std::string_view key, std::string_view doc);
  /// true or false; without a fallback the key is required.
  bool flag(std::string_view key, std::string_view doc, std::optional<bool> fallback);
  /// One of a few names.
  std::string choice(std::string_view key, std::span<const std::string> names, std::string_view doc,
                     const std::optional<std::string>& fallback = {});
  /// One of many names, to which another program may have added: the schema proposes them and takes others.
  std::string known_name(std::string_view key, std::span<const std::string> names, std::string_view doc);
  /// Exactly `size` numbers, all within the rule; `rule.fallback` fills all of them.
  std::vector<double> numbers(std::string_view key, std::size_t size, const Number& rule);
  /// Like numbers(), for a key that may be absent without a default.
  std::optional<std::vector<double>> optional_numbers(std::string_view key, std::size_t size, const Number& rule);
  /// Exactly `size` whole numbers.
  std::vector<std::int64_t> integers(std::string_view key, std::size_t size, const Integer& rule);
  /// At least so many points, each a list of `size` numbers.
  std::vector<std::vector<double>> points(std::string_view key, std::size_t size, std::size_t at_least,
                                          const Number& rule);
  /// The name of a file, relative to the folder of the document; the whole path is what is echoed, so that the echo may
  /// lie elsewhere. Whether there is such a file is not looked at. Required.
  std::filesystem::path path(std::string_view key, std::string_view doc);
  /// A number or a string that is an expression.
  Expression expression(std::string_view key, const ExpressionScope& scope, const Number& rule);
  /// Exactly `size` of them, like the components of a vector.
  std::vector<Expression> expressions(std::string_view key, std::size_t size, const ExpressionScope& scope,
                                      const Number& rule);
  /// Like expression() and expressions(), for a key that may be absent without a default.
  std::optional<Expression> optional_expression(std::string_view key, const ExpressionScope& scope, const Number& rule);
  /// Like expressions(), for a key that may be absent without a default.
  std::optional<std::vector<Expression>> optional_expressions(std::string_view key, std::size_t size,
                                                              const ExpressionScope& scope, const Number& rule);
  /// An object with any keys whose values are numbers, like `constants`.
  std::map<std::string, double> named_numbers(std::string_view key, std::string_view doc);

  bool has(std::string_view key) const;  ///< true in description mode
  /// The value under a key as it stands, marked as read, for shapes the other calls cannot state. `schema` is its JSON
  /// Schema (with "description"), `fallback` what is returned and echoed if it is absent.
  Json raw(std::string_view key, const Json& schema, const Json& fallback);

  /// What an absent object is: `{}`, so that defaults apply; a problem; not read at all.
  enum class Presence { optional, required, only_if_present };
  /// The object under a key, read by `read`.
  void object(std::string_view key, std::string_view doc, Presence presence, const std::function<void(Input&)>& read);
  /// Every element of the list under a key, each an object. An absent list is empty.
  void list(std::string_view key, std::string_view doc, std::size_t at_least,
            const std::function<void(Input&, std::size_t)>& read);
  /// Every object of the object under a key, whose own keys are names that the user chooses. An absent one is empty.
  void named_objects(std::string_view key, std::string_view doc,
                     const std::function<void(Input&, const std::string& name)>& read);
  /// Names, and what reads the further keys of each from the same Input.
  using Variants = std::vector<std::pair<std::string, std::function<void(Input&)>>>;
  /// A name under `key` that decides which further keys of this object there are. A wrong name reads no variant, and
  /// the fallback or the first name is returned; the same holds for one_of().
  std::string variant(std::string_view key, std::string_view doc, const std::optional<std::string>& fallback,
                      const Variants& variants);
  /// Exactly one of the named sub-objects or values must be there, like shape {box | ball | where}.
  /// The callback reads the key from this Input.
  std::string one_of(std::string_view doc, const Variants& variants);

  /// Notes a problem that the rules cannot express at this place, at a key of it, or further below: `key` is empty or a
  /// JSON pointer without its first slash. Left out if a rule has already found one at or under that key, whose value
  /// is then not the user's. An empty `got` shows the key's value.
  void problem(std::string_view key, std::string what, std::string expected = {}, std::string got = {},
               std::string closest = {});
  /// Notes what is no problem, but may not be meant: a sentence about the value of a key (as in problem()).
  void remark(std::string_view key, const std::string& sentence);
  /// Which of the known names could be meant, by meaning or by letters; empty if none.
  std::string closest(std::string_view name, std::span<const std::string> known) const;
  /// Whether nothing wrong is known of a key (as in problem()), so that its value is the user's.
  bool sound(std::string_view key) const;
  /// How many elements the list at a key (as in problem()) has, read or not; none if there is no list.
  std::optional<std::size_t> elements(std::string_view key) const;
  /// The text at a key (as in problem()), read or not; none if there is no text.
  std::optional<std::string> text_at(std::string_view key) const;
  /// The keys of the object at a key (as in problem()), read or not; none if there is no object.
  std::vector<std::string> names(std::string_view key) const;
  /// Whether this is description mode: there is no document, values mean nothing.
  bool describing() const;
  /// JSON pointer of this place; empty at the root.
  const std::string& pointer() const;
  /// Describes the keys here as those of a place further up, so that objects may hold others of their own kind: call it
  /// in description mode instead of reading the keys once more. `pointer` is that of an object under a key, with `*`
  /// for each element of a list.
  void same_keys_as(const std::string& pointer);

 private:
  explicit Input(std::shared_ptr<InputPlace> place);
  std::shared_ptr<InputPlace> place_;
};

/// A document, what was understood of it, and what is wrong with it.
class Input::Document {
 public:
  /// \param json  must outlive the document.
  Document(const Json& json, std::string file);
  /// Description mode: no document, no problems.
  static Document describe();

  Input& root();
  /// Notes a problem for every key that nobody has read, with the closest name that could be meant. A required key that
  /// is missing while an unknown key is close to it is one problem, not two. Call once, after all is read.
  void finish();
  const std::vector<Problem>& problems() const;
  /// What was remarked, with the pointer before it.
  const std::vector<std::string>& remarks() const;
  /// \throws InputError if there are problems.
  void require_valid();
  /// The document as understood, defaults filled in, keys in reading order.
  Json echo() const;
  /// JSON Schema (draft 2020-12) of what the reading code accepts; units as "x-unit". Complete in description mode.
  Json schema() const;
  /// The keys as rows of a Markdown table: pointer, type and unit, default, meaning. Complete in description mode.
  std::string key_table() const;

 private:
  explicit Document(std::shared_ptr<InputRecord> record);
  std::shared_ptr<InputRecord> record_;
  Input root_;
};

}  // namespace minamo
