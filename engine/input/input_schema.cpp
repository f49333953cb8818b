#include "engine/input/input_place.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

bool needs_a_key(const ObjectShape& shape);

bool is_required(const KeyShape& key) {
  if (key.presence != KeyShape::Presence::by_content) return key.presence == KeyShape::Presence::required;
  return needs_a_key(*key.object);
}

bool needs_a_key(const ChoiceShape& choice) {
  if (choice.key.empty()) return true;
  return std::any_of(choice.alternatives.begin(), choice.alternatives.end(), [&](const Alternative& alternative) {
    return alternative.name == choice.fallback && needs_a_key(alternative.shape);
  });
}

/// Whether `{}` is refused.
bool needs_a_key(const ObjectShape& shape) {
  return std::any_of(shape.keys.begin(), shape.keys.end(), is_required) ||
         std::any_of(shape.choices.begin(), shape.choices.end(),
                     [](const auto& choice) { return needs_a_key(choice); });
}

bool is_list(const KeyShape& key) { return !key.items.empty(); }

Json key_schema(const KeyShape& key) {
  if (!key.object) return key.schema;
  Json schema{{"type", is_list(key) ? "array" : "object"}};
  if (is_list(key))
    schema["items"] = object_schema(*key.object);
  else if (key.names_objects)
    schema["additionalProperties"] = object_schema(*key.object);
  else
    schema = object_schema(*key.object);
  schema.update(key.schema);
  return schema;
}

std::vector<std::string> all_names(const ObjectShape& shape) {
  std::vector<std::string> names;
  for (const KeyShape& key : shape.keys) names.push_back(key.name);
  for (const ChoiceShape& choice : shape.choices)
    for (const Alternative& alternative : choice.alternatives)
      for (const std::string& name : all_names(alternative.shape))
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

/// The keys and choices of the shape, open to further keys.
Json open_schema(const ObjectShape& shape);

/// One alternative: its own keys, and none of the other alternatives'.
Json alternative_schema(const ChoiceShape& choice, const Alternative& alternative,
                        const std::vector<std::string>& brought) {
  Json schema = open_schema(alternative.shape);
  Json properties = Json::object();
  if (!choice.key.empty()) properties[choice.key] = Json{{"const", alternative.name}};
  properties.update(schema["properties"]);
  const auto own = all_names(alternative.shape);
  for (const std::string& name : brought)
    if (std::find(own.begin(), own.end(), name) == own.end()) properties[name] = false;
  schema["properties"] = std::move(properties);
  Json& required = schema["required"];
  const std::string& marker = choice.key.empty() ? alternative.name : choice.key;
  const bool is_default = !choice.key.empty() && choice.fallback == alternative.name;
  if (!is_default && std::find(required.begin(), required.end(), marker) == required.end()) required.push_back(marker);
  return schema;
}

Json choice_schema(const ChoiceShape& choice, const ObjectShape& outer) {
  std::vector<std::string> brought;
  for (const Alternative& alternative : choice.alternatives)
    for (const std::string& name : all_names(alternative.shape)) {
      const auto is_name = [&](const KeyShape& key) { return key.name == name; };
      if (std::none_of(outer.keys.begin(), outer.keys.end(), is_name)) brought.push_back(name);
    }
  Json schema{{"description", choice.doc}, {"oneOf", Json::array()}};
  for (const Alternative& alternative : choice.alternatives)
    schema["oneOf"].push_back(alternative_schema(choice, alternative, brought));
  return schema;
}

Json open_schema(const ObjectShape& shape) {
  Json schema{{"properties", Json::object()}, {"required", Json::array()}};
  for (const KeyShape& key : shape.keys) {
    schema["properties"][key.name] = key_schema(key);
    if (is_required(key)) schema["required"].push_back(key.name);
  }
  for (const ChoiceShape& choice : shape.choices) schema["allOf"].push_back(choice_schema(choice, shape));
  return schema;
}

std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string types_text(const Json& types) {
  if (!types.is_array()) return types.get<std::string>();
  std::string text;
  for (const Json& type : types) text.append(text.empty() ? "" : " or ").append(type.get<std::string>());
  return text;
}

/// Of a value that only its schema describes.
std::string raw_type_text(const Json& schema) {
  if (!schema.contains("type")) return "see meaning";
  if (!schema.contains("items") || !schema["items"].contains("enum")) return types_text(schema["type"]);
  return "list of some of " + listed(schema["items"]["enum"].get<std::vector<std::string>>());
}

std::string type_text(const KeyShape& key) {
  std::string text = key.expected;
  if (key.schema.contains("maxItems")) {
    const Json &least = key.schema["minItems"], most = key.schema["maxItems"];
    text = fmt::format("list of {}{} {}", least.dump(), least == most ? "" : " or " + most.dump(), key.items);
  }
  if (text.empty()) text = raw_type_text(key.schema);
  for (const std::string article : {"a ", "an "})
    if (text.starts_with(article)) return text.substr(article.size());
  return text;
}

std::string default_text(const KeyShape& key) {
  const bool varies = key.schema.contains("maxItems") && key.schema["minItems"] != key.schema["maxItems"];
  if (key.fallback && varies) return one_line(key.fallback->front()) + " each";
  if (key.fallback) return one_line(*key.fallback);
  return is_required(key) ? "required" : "optional";
}

/// When a key of an alternative may stand: ` (with scheme "flip")`.
std::string condition_text(const ChoiceShape& choice, const Alternative& alternative, const std::string& key) {
  if (!choice.key.empty()) return fmt::format(" (with {} \"{}\")", choice.key, alternative.name);
  if (key != alternative.name) return fmt::format(" (with {})", alternative.name);
  const auto& all = choice.alternatives;
  if (all.size() > 6) return fmt::format(" (one of {} to {})", all.front().name, all.back().name);
  std::string others;
  for (const Alternative& other : choice.alternatives)
    if (other.name != alternative.name) others += (others.empty() ? "" : ", ") + other.name;
  return others.empty() ? "" : fmt::format(" (instead of {})", others);
}

using Condition = std::function<std::string(const std::string& key)>;

std::string table_rows(const ObjectShape& shape, const std::string& pointer, const Condition& condition) {
  std::string rows;
  for (const KeyShape& key : shape.keys) {
    const std::string here = fmt::format("{}/{}", pointer, key.name);
    const std::string meaning = key.schema.value("description", "") + condition(key.name);
    rows += fmt::format("| {} | {} | {} | {} |\n", cell(here), cell(type_text(key)), cell(default_text(key)),
                        cell(meaning));
    if (key.object) rows += table_rows(*key.object, here + (is_list(key) || key.names_objects ? "/*" : ""));
  }
  for (const ChoiceShape& choice : shape.choices)
    for (const Alternative& alternative : choice.alternatives)
      rows += table_rows(alternative.shape, pointer, [&](const std::string& key) {
        return condition(key) + condition_text(choice, alternative, key);
      });
  return rows;
}

/// `/list/*/key` as the place of its schema: `#/properties/list/items/properties/key`.
std::string reference(const std::string& pointer) {
  std::string reference = "#";
  for (std::size_t at = 1; at <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    const std::string step = pointer.substr(at, end - at);
    reference += step == "*" ? "/items" : "/properties/" + step;
    at = end + 1;
  }
  return reference;
}

}  // namespace

Json object_schema(const ObjectShape& shape) {
  if (!shape.same_as.empty()) return {{"$ref", reference(shape.same_as)}};
  Json schema{{"type", "object"}};
  schema.update(open_schema(shape));
  for (const std::string& name : all_names(shape))  // those of the choices, whose schemas are in the alternatives
    if (!schema["properties"].contains(name)) schema["properties"][name] = true;
  schema["additionalProperties"] = false;
  return schema;
}

std::string table_rows(const ObjectShape& shape, const std::string& pointer) {
  return table_rows(shape, pointer, [](const std::string&) { return std::string(); });
}

}  // namespace minamo
