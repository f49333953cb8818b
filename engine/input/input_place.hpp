#pragma once
/// \file
/// What the sources of input.hpp share: the place that an Input stands for, and the shape its reading calls describe.

#include "engine/input/input.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace minamo {

struct ObjectShape;

/// A key as its reading call states it.
struct KeyShape {
  enum class Presence { required, optional, by_content };  ///< by_content: required if the object under it needs a key

  std::string name;
  std::string expected;  ///< as the messages say it: "a number > 0 [kg/m^3]"
  std::string items;     ///< of a list, in the plural: "numbers > 0 [kg/m^3]"
  Json schema;
  std::optional<Json> fallback;
  Presence presence = Presence::required;
  std::shared_ptr<ObjectShape> object;  ///< the object under the key, or each element of the list under it
  bool names_objects = false;           ///< the object's own keys are free names, `object` is what is under each
};

struct ChoiceShape;

/// The keys of an object, and the choices that bring further ones.
struct ObjectShape {
  std::vector<KeyShape> keys;
  std::vector<ChoiceShape> choices;
  std::string same_as = {};  ///< pointer of the object whose keys these are; empty: they are told here

  /// Adds a key, or widens the one of that name to both sizes.
  KeyShape& add(KeyShape key);
  ChoiceShape& choice(ChoiceShape choice);
};

struct Alternative {
  std::string name;
  ObjectShape shape;
};

struct ChoiceShape {
  std::string key;  ///< holds the alternative's name; empty: the alternative is the key of its name
  std::string doc;
  std::optional<std::string> fallback;
  std::vector<Alternative> alternatives;
};

/// What all places of a document note together.
struct InputRecord {
  std::string file;
  bool describing = false;
  std::vector<Problem> problems;
  std::vector<std::string> remarks;
  std::set<std::string> unsound;              ///< pointers of the problems
  std::optional<ExpressionScope> of_numbers;  ///< what a string in the place of a number may use, once that is known
  std::span<const OtherWord> words = {};      ///< of other programs
};

/// An object of the document, or the lack of one.
struct InputPlace {
  enum class Standing {
    present,
    absent,  ///< reads as {}
    silent   ///< what should be here is itself a problem: nothing further is noted
  };

  std::shared_ptr<InputRecord> record;
  std::string pointer;
  const Json* object = nullptr;  ///< null unless present
  Standing standing = Standing::absent;
  InputPlace* parent = nullptr;  ///< with the key there; none for the root
  std::string key;
  bool unknown_keys_pass = false;     ///< it could not be decided which keys there are
  std::string decided;                ///< what decided it, as the messages say it: ` with scheme "pic"`
  std::vector<std::string> known;     ///< keys asked for
  std::vector<std::string> excluded;  ///< of them, those that another key excludes
  std::map<std::string, std::vector<std::size_t>, std::less<>> missing;  ///< problems noted because this key is missing
  std::map<std::string, std::vector<std::shared_ptr<InputPlace>>, std::less<>> children;
  Json echo = Json::object();
  std::shared_ptr<ObjectShape> shape = std::make_shared<ObjectShape>();
  ObjectShape* open_shape = shape.get();  ///< the shape, or the alternative being read

  std::string pointer_to(std::string_view name) const;
  /// The value under a key; null if there is none.
  const Json* find(std::string_view name) const;
  /// States a key, which then is known.
  const KeyShape& declare(KeyShape key_shape);
  /// The place under a key, or of an element of the list under it.
  std::shared_ptr<InputPlace> child(std::string_view name, std::optional<std::size_t> element);

  void note(Problem problem);
  void note(const std::string& at, std::string what, std::string expected, const Json& got, std::string closest = {});
  void note_missing(const std::vector<std::string>& names, Problem problem);
};

/// A rule in words: "a number > 0 [m]", "numbers > 0 [m]".
struct Phrase {
  std::string one;
  std::string many;
};
Phrase phrase(const Number& rule);
Phrase phrase(const Integer& rule);
Phrase phrase(const Number& rule, const ExpressionScope& scope);

Json schema_of(const Number& rule);
Json schema_of(const Integer& rule);

bool fits(const Number& rule, double value);
bool fits(const Integer& rule, std::int64_t value);

/// The fallback, or else a value that fits.
double harmless(const Number& rule);
std::int64_t harmless(const Integer& rule);

/// A number as a person would write it: 1, not 1.0.
Json json_number(double value);
/// On one line, with a space after each comma.
std::string one_line(const Json& value);

/// The name under a key, one of a few; nothing, with the problem noted, if it is missing or wrong.
/// \param schema  without the description.
std::optional<std::string> read_name(InputPlace& place, std::string_view key, std::span<const std::string> names,
                                     const Json& schema, std::string_view doc,
                                     const std::optional<std::string>& fallback);

/// The shape as JSON Schema, and as rows of a Markdown table.
Json object_schema(const ObjectShape& shape);
std::string table_rows(const ObjectShape& shape, const std::string& pointer);

}  // namespace minamo
