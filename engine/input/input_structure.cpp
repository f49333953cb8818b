#include "engine/input/input_place.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

using Standing = InputPlace::Standing;

KeyShape object_key(std::string_view key, std::string_view doc, KeyShape::Presence presence) {
  KeyShape shape{std::string(key), "an object", {}, Json::object(), {}, presence, std::make_shared<ObjectShape>()};
  shape.schema["description"] = doc;
  return shape;
}

KeyShape::Presence presence_of(Input::Presence presence) {
  if (presence == Input::Presence::required) return KeyShape::Presence::required;
  return presence == Input::Presence::optional ? KeyShape::Presence::by_content : KeyShape::Presence::optional;
}

KeyShape list_key(std::string_view key, std::string_view doc, std::size_t at_least) {
  const std::string least = std::to_string(at_least) + (at_least == 1 ? " object" : " objects");
  KeyShape shape = object_key(key, doc, KeyShape::Presence::required);
  shape.expected = at_least == 0 ? "a list of objects" : "a list of at least " + least;
  shape.items = "objects";
  shape.schema["minItems"] = at_least;
  if (at_least > 0) return shape;
  shape.fallback = Json::array();
  shape.schema["default"] = Json::array();
  shape.presence = KeyShape::Presence::optional;
  return shape;
}

void open(InputPlace& place, Standing standing, const Json* object, std::shared_ptr<ObjectShape> shape) {
  place.standing = standing;
  place.object = standing == Standing::present ? object : nullptr;
  place.shape = std::move(shape);
  place.open_shape = place.shape.get();
}

/// Whether the value is a list that is long enough; notes the problem if not.
bool is_list(InputPlace& place, const std::string& at, const Json& value, std::size_t at_least,
             const std::string& expected) {
  const bool is_long_enough = value.is_array() && value.size() >= at_least;
  if (!is_long_enough) place.note(at, value.is_array() ? "too short" : "wrong type", expected, value);
  return is_long_enough;
}

std::string pointer_below(const std::string& pointer, std::string_view key) {
  return key.empty() ? pointer : fmt::format("{}/{}", pointer, key);
}

/// The value at a pointer without its first slash; null if there is none.
const Json* below(const InputPlace& place, std::string_view key) {
  const Json::json_pointer pointer(pointer_below({}, key));
  return place.object && place.object->contains(pointer) ? &place.object->at(pointer) : nullptr;
}

std::vector<std::string> names_of(const Input::Variants& variants) {
  std::vector<std::string> names;
  for (const auto& [name, read] : variants) names.push_back(name);
  return names;
}

ChoiceShape choice_shape(std::string_view key, std::string_view doc, std::optional<std::string> fallback,
                         const Input::Variants& variants) {
  ChoiceShape choice{std::string(key), std::string(doc), std::move(fallback), {}};
  for (const auto& [name, read] : variants) choice.alternatives.push_back({name, {}});
  return choice;
}

/// Reads the chosen variants, in the order in which they are chosen; their keys belong to their alternatives.
void read_chosen(Input& input, InputPlace& place, ChoiceShape choice, const Input::Variants& variants,
                 const std::vector<std::string>& chosen) {
  ObjectShape* const outer = place.open_shape;
  ChoiceShape& shape = outer->choice(std::move(choice));
  for (const std::string& name : chosen) {
    const auto variant = std::find_if(variants.begin(), variants.end(), [&](const auto& v) { return v.first == name; });
    place.open_shape = &shape.alternatives[static_cast<std::size_t>(variant - variants.begin())].shape;
    variant->second(input);
    place.open_shape = outer;
  }
}

/// The default last: what is read later then depends on it, as in a document that names no variant.
std::vector<std::string> in_order_of_description(std::vector<std::string> names,
                                                 const std::optional<std::string>& fallback) {
  std::stable_partition(names.begin(), names.end(), [&](const std::string& name) { return name != fallback; });
  return names;
}

}  // namespace

void Input::object(std::string_view key, std::string_view doc, Presence presence,
                   const std::function<void(Input&)>& read) {
  const auto shape = place_->declare(object_key(key, doc, presence_of(presence))).object;
  const Json* value = place_->find(key);
  if (!value && presence == Presence::only_if_present && !describing()) return;
  Standing standing = value                                  ? Standing::present
                      : place_->standing == Standing::silent ? Standing::silent
                                                             : Standing::absent;
  if (value && !value->is_object()) {
    place_->note(place_->pointer_to(key), "wrong type", "an object", *value);
    standing = Standing::silent;
  } else if (!value && presence == Presence::required) {
    place_->note_missing({std::string(key)}, {{}, place_->pointer_to(key), "missing key", "an object", {}, {}});
    standing = Standing::silent;
  }
  Input child(place_->child(key, {}));
  open(*child.place_, standing, value, shape);
  read(child);
  place_->echo[std::string(key)] = child.place_->echo;
}

void Input::list(std::string_view key, std::string_view doc, std::size_t at_least,
                 const std::function<void(Input&, std::size_t)>& read) {
  const KeyShape shape = place_->declare(list_key(key, doc, at_least));
  const std::string at = place_->pointer_to(key);
  const Json* value = place_->find(key);
  if (!value && at_least > 0) place_->note_missing({shape.name}, {{}, at, "missing key", shape.expected, {}, {}});
  Json& echo = place_->echo[shape.name] = Json::array();
  if (describing()) {
    Input element(place_->child(key, 0));
    open(*element.place_, Standing::absent, nullptr, shape.object);
    read(element, 0);
  }
  if (!value || !is_list(*place_, at, *value, at_least, shape.expected)) return;
  for (std::size_t i = 0; i < value->size(); ++i) {
    const Json& object = (*value)[i];
    if (!object.is_object()) {
      place_->note(at + "/" + std::to_string(i), "wrong type", "an object", object);
      continue;
    }
    Input element(place_->child(key, i));
    open(*element.place_, Standing::present, &object, shape.object);
    read(element, i);
    echo.push_back(element.place_->echo);
  }
}

void Input::named_objects(std::string_view key, std::string_view doc,
                          const std::function<void(Input&, const std::string&)>& read) {
  KeyShape named = object_key(key, doc, KeyShape::Presence::optional);
  named.expected = "an object of objects";
  named.fallback = Json::object();
  named.schema["default"] = Json::object();
  named.names_objects = true;
  const auto shape = place_->declare(std::move(named)).object;
  const Json* value = place_->find(key);
  if (value && !value->is_object()) place_->note(place_->pointer_to(key), "wrong type", "an object of objects", *value);
  Input names(place_->child(key, {}));
  open(*names.place_, Standing::present, value && value->is_object() ? value : nullptr,
       std::make_shared<ObjectShape>());
  const auto read_one = [&](const std::string& name, const Json* object) {
    names.place_->known.push_back(name);
    Input one(names.place_->child(name, {}));
    open(*one.place_, object ? Standing::present : Standing::silent, object, shape);
    read(one, name);
    names.place_->echo[name] = one.place_->echo;
  };
  if (describing()) read_one("*", nullptr);
  if (names.place_->object) {
    for (const auto& [name, object] : names.place_->object->items()) {
      if (!object.is_object()) place_->note(names.place_->pointer_to(name), "wrong type", "an object", object);
      read_one(name, object.is_object() ? &object : nullptr);
    }
  }
  place_->echo[std::string(key)] = names.place_->echo;
}

std::string Input::variant(std::string_view key, std::string_view doc, const std::optional<std::string>& fallback,
                           const Variants& variants) {
  const auto names = names_of(variants);
  const auto name = read_name(*place_, key, names, {{"enum", Json(names)}}, doc, fallback);
  if (!name) place_->unknown_keys_pass = true;
  if (name) place_->decided.append(fmt::format(" with {} \"{}\"", key, *name));
  const auto chosen = describing() ? in_order_of_description(names, fallback)
                      : name       ? std::vector{*name}
                                   : std::vector<std::string>{};
  read_chosen(*this, *place_, choice_shape(key, doc, fallback, variants), variants, chosen);
  return name.value_or(fallback.value_or(names.front()));
}

std::string Input::one_of(std::string_view doc, const Variants& variants) {
  const auto names = names_of(variants);
  std::vector<std::string> present;
  for (const std::string& name : names) {
    if (place_->find(name)) present.push_back(name);
    if (std::find(place_->known.begin(), place_->known.end(), name) == place_->known.end())
      place_->known.push_back(name);
  }
  const std::string expected = fmt::format("exactly {}", one_of_text(names));
  if (present.empty()) place_->note_missing(names, {{}, pointer(), "missing key", expected, {}, {}});
  if (present.size() > 1) place_->note({{}, pointer(), "keys that exclude each other", expected, listed(present), {}});
  const bool decided = present.size() == 1;
  if (!decided) place_->unknown_keys_pass = true;
  if (decided) {
    place_->decided.append(fmt::format(" next to \"{}\"", present.front()));
    std::copy_if(names.begin(), names.end(), std::back_inserter(place_->excluded),
                 [&](const std::string& name) { return name != present.front(); });
  }
  const auto chosen = describing() ? names : decided ? present : std::vector<std::string>{};
  read_chosen(*this, *place_, choice_shape({}, doc, {}, variants), variants, chosen);
  return decided ? present.front() : names.front();
}

bool Input::has(std::string_view key) const { return describing() || place_->find(key) != nullptr; }

void Input::problem(std::string_view key, std::string what, std::string expected, std::string got,
                    std::string closest) {
  if (!key.empty() && !sound(key)) return;
  const Json* value = key.empty() ? nullptr : below(*place_, key);
  if (got.empty() && value) got = shown(*value);
  place_->note(
      {{}, pointer_below(pointer(), key), std::move(what), std::move(expected), std::move(got), std::move(closest)});
}

void Input::remark(std::string_view key, const std::string& sentence) {
  if (!describing()) place_->record->remarks.push_back(pointer_below(pointer(), key) + ": " + sentence);
}

bool Input::sound(std::string_view key) const {
  const std::string at = pointer_below(pointer(), key);
  const auto& unsound = place_->record->unsound;
  const auto below = unsound.lower_bound(at + "/");
  return !unsound.contains(at) && (below == unsound.end() || !below->starts_with(at + "/"));
}

std::optional<std::size_t> Input::elements(std::string_view key) const {
  const Json* value = below(*place_, key);
  return value && value->is_array() ? std::optional(value->size()) : std::nullopt;
}

std::optional<std::string> Input::text_at(std::string_view key) const {
  const Json* value = below(*place_, key);
  return value && value->is_string() ? std::optional(value->get<std::string>()) : std::nullopt;
}

std::vector<std::string> Input::names(std::string_view key) const {
  std::vector<std::string> names;
  const Json* value = below(*place_, key);
  if (!value || !value->is_object()) return names;
  for (const auto& [name, content] : value->items()) names.push_back(name);
  return names;
}

bool Input::describing() const { return place_->record->describing; }

const std::string& Input::pointer() const { return place_->pointer; }

void Input::same_keys_as(const std::string& pointer) { place_->shape->same_as = pointer; }

}  // namespace minamo
