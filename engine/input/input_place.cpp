#include "engine/input/input_place.hpp"

#include <algorithm>

namespace minamo {

KeyShape& ObjectShape::add(KeyShape key) {
  const auto same = std::find_if(keys.begin(), keys.end(), [&](const KeyShape& k) { return k.name == key.name; });
  if (same == keys.end()) return keys.emplace_back(std::move(key));
  if (same->schema.contains("maxItems") && key.schema.contains("maxItems")) {
    key.schema["minItems"] = std::min(same->schema["minItems"], key.schema["minItems"]);
    key.schema["maxItems"] = std::max(same->schema["maxItems"], key.schema["maxItems"]);
    if (same->schema["maxItems"] != same->schema["minItems"] || key.schema["maxItems"] != key.schema["minItems"])
      key.schema.erase("default");  // of one size only
  }
  if (same->object) key.object = same->object;
  *same = std::move(key);
  return *same;
}

ChoiceShape& ObjectShape::choice(ChoiceShape choice) {
  const auto is_same = [&](const ChoiceShape& other) {
    return other.key == choice.key &&
           std::equal(other.alternatives.begin(), other.alternatives.end(), choice.alternatives.begin(),
                      choice.alternatives.end(), [](const auto& a, const auto& b) { return a.name == b.name; });
  };
  const auto same = std::find_if(choices.begin(), choices.end(), is_same);
  return same == choices.end() ? choices.emplace_back(std::move(choice)) : *same;
}

std::string InputPlace::pointer_to(std::string_view name) const { return (pointer + '/').append(pointer_token(name)); }

const Json* InputPlace::find(std::string_view name) const {
  if (!object) return nullptr;
  const auto found = object->find(std::string(name));
  return found == object->end() ? nullptr : &*found;
}

const KeyShape& InputPlace::declare(KeyShape key_shape) {
  if (std::find(known.begin(), known.end(), key_shape.name) == known.end()) known.push_back(key_shape.name);
  return open_shape->add(std::move(key_shape));
}

std::shared_ptr<InputPlace> InputPlace::child(std::string_view name, std::optional<std::size_t> element) {
  auto& places = children[std::string(name)];
  const std::size_t index = element.value_or(0);
  if (places.size() <= index) places.resize(index + 1);
  if (!places[index]) {
    places[index] = std::make_shared<InputPlace>();
    places[index]->record = record;
    places[index]->parent = this;
    places[index]->key = name;
    places[index]->pointer = pointer_to(name);
    if (element) places[index]->pointer.append("/").append(record->describing ? "*" : std::to_string(index));
  }
  return places[index];
}

void InputPlace::note(Problem problem) {
  if (record->describing || standing == Standing::silent) return;
  problem.file = record->file;
  record->unsound.insert(problem.pointer);
  record->problems.push_back(std::move(problem));
}

void InputPlace::note(const std::string& at, std::string what, std::string expected, const Json& got,
                      std::string closest) {
  note({{}, at, std::move(what), std::move(expected), shown(got), std::move(closest)});
}

void InputPlace::note_missing(const std::vector<std::string>& names, Problem problem) {
  if (record->describing || standing == Standing::silent) return;
  const std::size_t index = record->problems.size();
  for (const std::string& name : names) missing[name].push_back(index);
  // In an absent object a key is missing because the object is: a misspelt name of the object explains both.
  for (InputPlace* place = this; place->standing == Standing::absent && place->parent; place = place->parent)
    place->parent->missing[place->key].push_back(index);
  note(std::move(problem));
}

}  // namespace minamo
