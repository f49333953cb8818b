#include "engine/input/input.hpp"

#include "engine/input/input_place.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// The value under a key, checked; the fallback if it is absent; nothing, with the problem noted, if it is missing or
/// wrong.
template <class Value, class Check>
std::optional<Value> read_key(InputPlace& place, KeyShape shape, const std::optional<Value>& fallback,
                              const Check& check) {
  const KeyShape key = place.declare(std::move(shape));
  const Json* value = place.find(key.name);
  if (value) {
    place.echo[key.name] = *value;
    return check(place.pointer_to(key.name), *value);
  }
  if (key.fallback) place.echo[key.name] = *key.fallback;
  if (key.presence == KeyShape::Presence::required)
    place.note_missing({key.name}, {{}, place.pointer_to(key.name), "missing key", key.expected, {}, {}});
  return fallback;
}

/// The list under a key, each element checked.
template <class Value, class Check>
std::optional<std::vector<Value>> read_elements(InputPlace& place, KeyShape shape, std::size_t size,
                                                const std::optional<Value>& fallback, const Check& check) {
  const std::string expected = shape.expected;
  const auto check_all = [&](const std::string& at, const Json& list) -> std::optional<std::vector<Value>> {
    if (!list.is_array() || list.size() != size) {
      place.note(at, list.is_array() ? "wrong length" : "wrong type", expected, list);
      return {};
    }
    std::vector<Value> values;
    for (std::size_t i = 0; i < size; ++i)
      if (auto value = check(at + "/" + std::to_string(i), list[i])) values.push_back(std::move(*value));
    return values.size() == size ? std::optional(std::move(values)) : std::nullopt;
  };
  std::optional<std::vector<Value>> all;
  if (fallback) all.emplace(size, *fallback);
  return read_key(place, std::move(shape), all, check_all);
}

KeyShape key_shape(std::string_view key, std::string expected, Json schema, std::string_view doc,
                   std::optional<Json> fallback) {
  schema["description"] = doc;
  if (fallback) schema["default"] = *fallback;
  const auto presence = fallback ? KeyShape::Presence::optional : KeyShape::Presence::required;
  return {std::string(key), std::move(expected), {}, std::move(schema), std::move(fallback), presence, {}};
}

KeyShape list_shape(std::string_view key, const Phrase& words, Json element, std::size_t size, std::string_view doc,
                    const std::optional<Json>& fallback) {
  Json schema{{"type", "array"}, {"items", std::move(element)}, {"minItems", size}, {"maxItems", size}};
  std::optional<Json> all;
  if (fallback) all = Json(Json::array_t(size, *fallback));
  KeyShape shape = key_shape(key, "a list of " + std::to_string(size) + " " + words.many, std::move(schema), doc, all);
  shape.items = words.many;
  return shape;
}

Json as_json(double value) { return json_number(value); }
template <class T>
Json as_json(const T& value) {
  return value;
}
template <class T>
Json as_json(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(as_json(value));
  return list;
}

template <class T>
std::optional<Json> json_of(const std::optional<T>& value) {
  return value ? std::optional(as_json(*value)) : std::nullopt;
}

std::optional<Expression> parsed(InputPlace& place, const std::string& at, const Json& value,
                                 const ExpressionScope& scope, const Number& rule) {
  try {
    return Expression(value.get<std::string>(), scope);
  } catch (const ExpressionError& error) {
    const auto names = known_names(scope);
    std::string closest = meant_in_expression(place.record->words, value.get_ref<const std::string&>(), names);
    if (closest.empty() && !error.token.empty()) closest = closest_name(error.token, names);
    place.note(at, std::string("not an expression: ") + error.what(), phrase(rule, scope).one, value, closest);
    return {};
  }
}

std::optional<Expression> check_expression(InputPlace& place, const std::string& at, const Json& value,
                                           const ExpressionScope& scope, const Number& rule) {
  std::optional<Expression> expression;
  if (value.is_string())
    expression = parsed(place, at, value, scope, rule);
  else if (value.is_number())
    expression = Expression(value.get<double>());
  else
    place.note(at, "wrong type", phrase(rule, scope).one, value);
  if (!expression || !expression->is_constant() || fits(rule, (*expression)({}))) return expression;
  place.note(at, std::isfinite((*expression)({})) ? "out of range" : "not finite", phrase(rule, scope).one, value);
  return {};
}

/// A number, or what an expression in constants comes to; nothing, with the problem noted, if it is neither.
std::optional<double> evaluated(InputPlace& place, const std::string& at, const Json& value, const Number& range,
                                const std::string& expected) {
  const auto& scope = place.record->of_numbers;
  if (value.is_number()) return value.get<double>();
  if (value.is_string() && scope) {
    const auto expression = parsed(place, at, value, *scope, range);
    return expression ? std::optional((*expression)({})) : std::nullopt;
  }
  place.note(at, "wrong type", expected, value);
  return {};
}

std::optional<double> checked(InputPlace& place, const std::string& at, const Json& value, const Number& rule) {
  const auto number = evaluated(place, at, value, rule, phrase(rule).one);
  if (!number || fits(rule, *number)) return number;
  place.note(at, "out of range", phrase(rule).one, value);
  return {};
}

std::optional<std::int64_t> checked(InputPlace& place, const std::string& at, const Json& value, const Integer& rule) {
  const auto number = evaluated(place, at, value, {}, phrase(rule).one);
  if (!number) return {};
  const bool representable = *number >= -0x1p63 && *number < 0x1p63;
  // A whole number beyond 2^53 is none of a double.
  const auto whole = [&] { return value.is_number() ? value.get<std::int64_t>() : static_cast<std::int64_t>(*number); };
  if (std::trunc(*number) != *number) {
    place.note(at, "not a whole number", phrase(rule).one, value);
  } else if (!representable || !fits(rule, whole())) {
    place.note(at, "out of range", phrase(rule).one, value);
  } else {
    return whole();
  }
  return {};
}

Json or_text(Json schema) {
  schema["type"] = Json::array({schema["type"], "string"});
  return schema;
}

Json expression_schema(const Number& rule) { return or_text(schema_of(rule)); }

template <class Rule>
Json number_schema(const InputPlace& place, const Rule& rule) {
  return place.record->of_numbers ? or_text(schema_of(rule)) : schema_of(rule);
}

bool holds_text(const Json& value) {
  return value.is_array() ? std::any_of(value.begin(), value.end(), holds_text) : value.is_string();
}

/// Echoes what expressions came to; numbers stay as they were written.
template <class Value>
std::optional<Value> echo_evaluated(InputPlace& place, std::string_view key, std::optional<Value> value) {
  const Json* written = place.find(key);
  if (!value || !written) return value;
  if (holds_text(*written)) place.echo[std::string(key)] = as_json(*value);
  return value;
}

/// A number, or a whole one, under a key.
template <class Rule>
auto read_number(InputPlace& place, std::string_view key, const Rule& rule) {
  const auto check = [&](const std::string& at, const Json& value) { return checked(place, at, value, rule); };
  KeyShape shape = key_shape(key, phrase(rule).one, number_schema(place, rule), rule.doc, json_of(rule.fallback));
  return echo_evaluated(place, key, read_key(place, std::move(shape), rule.fallback, check)).value_or(harmless(rule));
}

/// A list of them.
template <class Rule>
auto read_numbers(InputPlace& place, std::string_view key, std::size_t size, const Rule& rule) {
  const auto check = [&](const std::string& at, const Json& value) { return checked(place, at, value, rule); };
  KeyShape shape = list_shape(key, phrase(rule), number_schema(place, rule), size, rule.doc, json_of(rule.fallback));
  return echo_evaluated(place, key, read_elements(place, std::move(shape), size, rule.fallback, check))
      .value_or(std::vector(size, harmless(rule)));
}

std::optional<Expression> constant(const std::optional<double>& value) {
  return value ? std::optional(Expression(*value)) : std::nullopt;
}

}  // namespace

void Input::use_words(std::span<const OtherWord> words) { place_->record->words = words; }

namespace {

std::string meant_or_closest(const InputPlace& place, std::string_view name, std::span<const std::string> known) {
  std::string meant = meant_name(place.record->words, name, known);
  return meant.empty() ? closest_name(name, known) : meant;
}

}  // namespace

std::string Input::closest(std::string_view name, std::span<const std::string> known) const {
  return meant_or_closest(*place_, name, known);
}

void Input::use_constants(const std::map<std::string, double>& constants) {
  place_->record->of_numbers = ExpressionScope{{}, constants};
}

double Input::number(std::string_view key, const Number& rule) { return read_number(*place_, key, rule); }

std::optional<double> Input::optional_number(std::string_view key, const Number& rule) {
  const auto check = [&](const std::string& at, const Json& value) { return checked(*place_, at, value, rule); };
  KeyShape shape = key_shape(key, phrase(rule).one, number_schema(*place_, rule), rule.doc, {});
  shape.presence = KeyShape::Presence::optional;
  return echo_evaluated(*place_, key, read_key(*place_, std::move(shape), std::optional<double>(), check));
}

std::int64_t Input::integer(std::string_view key, const Integer& rule) { return read_number(*place_, key, rule); }

namespace {

std::optional<std::string> read_text(InputPlace& place, KeyShape shape, const std::optional<std::string>& fallback) {
  return read_key(place, std::move(shape), fallback,
                  [&](const std::string& at, const Json& value) -> std::optional<std::string> {
                    if (value.is_string()) return value.get<std::string>();
                    place.note(at, "wrong type", "a string", value);
                    return {};
                  });
}

}  // namespace

std::string Input::text(std::string_view key, const Text& rule) {
  KeyShape shape = key_shape(key, "a string", {{"type", "string"}}, rule.doc, json_of(rule.fallback));
  return read_text(*place_, std::move(shape), rule.fallback).value_or(rule.fallback.value_or(""));
}

std::optional<std::string> Input::optional_text(std::string_view key, std::string_view doc) {
  KeyShape shape = key_shape(key, "a string", {{"type", "string"}}, doc, {});
  shape.presence = KeyShape::Presence::optional;
  return read_text(*place_, std::move(shape), {});
}

bool Input::flag(std::string_view key, std::string_view doc, std::optional<bool> fallback) {
  const auto check = [&](const std::string& at, const Json& value) -> std::optional<bool> {
    if (value.is_boolean()) return value.get<bool>();
    place_->note(at, "wrong type", "true or false", value);
    return {};
  };
  KeyShape shape = key_shape(key, "true or false", {{"type", "boolean"}}, doc, json_of(fallback));
  return read_key(*place_, std::move(shape), fallback, check).value_or(fallback.value_or(false));
}

std::optional<std::string> read_name(InputPlace& place, std::string_view key, std::span<const std::string> names,
                                     const Json& schema, std::string_view doc,
                                     const std::optional<std::string>& fallback) {
  const std::string expected = one_of_text(names);
  const auto check = [&](const std::string& at, const Json& value) -> std::optional<std::string> {
    const std::string name = value.is_string() ? value.get<std::string>() : std::string();
    if (!value.is_string())
      place.note(at, "wrong type", expected, value);
    else if (std::find(names.begin(), names.end(), name) == names.end())
      place.note(at, "unknown name", expected, value, meant_or_closest(place, name, names));
    else
      return name;
    return {};
  };
  return read_key(place, key_shape(key, expected, schema, doc, json_of(fallback)), fallback, check);
}

std::string Input::choice(std::string_view key, std::span<const std::string> names, std::string_view doc,
                          const std::optional<std::string>& fallback) {
  const Json schema{{"enum", Json(std::vector(names.begin(), names.end()))}};
  return read_name(*place_, key, names, schema, doc, fallback).value_or(fallback.value_or(names.front()));
}

std::string Input::known_name(std::string_view key, std::span<const std::string> names, std::string_view doc) {
  const Json schema{{"type", "string"}, {"examples", Json(std::vector(names.begin(), names.end()))}};
  return read_name(*place_, key, names, schema, doc, {}).value_or(names.front());
}

std::vector<double> Input::numbers(std::string_view key, std::size_t size, const Number& rule) {
  return read_numbers(*place_, key, size, rule);
}

std::optional<std::vector<double>> Input::optional_numbers(std::string_view key, std::size_t size, const Number& rule) {
  const auto check = [&](const std::string& at, const Json& value) { return checked(*place_, at, value, rule); };
  KeyShape shape = list_shape(key, phrase(rule), number_schema(*place_, rule), size, rule.doc, {});
  shape.presence = KeyShape::Presence::optional;
  return echo_evaluated(*place_, key, read_elements(*place_, std::move(shape), size, std::optional<double>(), check));
}

std::vector<std::int64_t> Input::integers(std::string_view key, std::size_t size, const Integer& rule) {
  return read_numbers(*place_, key, size, rule);
}

std::vector<std::vector<double>> Input::points(std::string_view key, std::size_t size, std::size_t at_least,
                                               const Number& rule) {
  const std::string one = fmt::format("{} {}", size, phrase(rule).many);
  const std::string expected = fmt::format("a list of at least {} lists of {}", at_least, one);
  using Points = std::vector<std::vector<double>>;
  const auto check_point = [&](const std::string& at, const Json& list) -> std::optional<std::vector<double>> {
    const bool is_point = list.is_array() && list.size() == size;
    if (!is_point) place_->note(at, list.is_array() ? "wrong length" : "wrong type", "a list of " + one, list);
    std::vector<double> point;
    for (std::size_t d = 0; is_point && d < size; ++d)
      if (const auto x = checked(*place_, fmt::format("{}/{}", at, d), list[d], rule)) point.push_back(*x);
    return point.size() == size ? std::optional(std::move(point)) : std::nullopt;
  };
  const auto check = [&](const std::string& at, const Json& list) -> std::optional<Points> {
    if (!list.is_array() || list.size() < at_least) {
      place_->note(at, list.is_array() ? "too short" : "wrong type", expected, list);
      return {};
    }
    Points points;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (auto point = check_point(fmt::format("{}/{}", at, i), list[i])) points.push_back(std::move(*point));
    return points.size() == list.size() ? std::optional(std::move(points)) : std::nullopt;
  };
  const Json point{{"type", "array"}, {"items", number_schema(*place_, rule)}, {"minItems", size}, {"maxItems", size}};
  Json schema{{"type", "array"}, {"items", point}, {"minItems", at_least}};
  KeyShape shape = key_shape(key, expected, std::move(schema), rule.doc, {});
  return echo_evaluated(*place_, key, read_key(*place_, std::move(shape), std::optional<Points>(), check))
      .value_or(Points(at_least, std::vector(size, harmless(rule))));
}

std::filesystem::path Input::path(std::string_view key, std::string_view doc) {
  const std::string name = text(key, {.doc = doc, .fallback = {}});
  if (!place_->find(key) || !sound(key)) return name;
  std::filesystem::path path = std::filesystem::absolute(place_->record->file).parent_path() / name;
  place_->echo[std::string(key)] = path.lexically_normal().string();
  return path.lexically_normal();
}

Expression Input::expression(std::string_view key, const ExpressionScope& scope, const Number& rule) {
  const auto check = [&](const std::string& at, const Json& value) {
    return check_expression(*place_, at, value, scope, rule);
  };
  KeyShape shape = key_shape(key, phrase(rule, scope).one, expression_schema(rule), rule.doc, json_of(rule.fallback));
  return read_key(*place_, std::move(shape), constant(rule.fallback), check).value_or(Expression(harmless(rule)));
}

std::vector<Expression> Input::expressions(std::string_view key, std::size_t size, const ExpressionScope& scope,
                                           const Number& rule) {
  const auto check = [&](const std::string& at, const Json& value) {
    return check_expression(*place_, at, value, scope, rule);
  };
  KeyShape shape =
      list_shape(key, phrase(rule, scope), expression_schema(rule), size, rule.doc, json_of(rule.fallback));
  return read_elements(*place_, std::move(shape), size, constant(rule.fallback), check)
      .value_or(std::vector<Expression>(size, Expression(harmless(rule))));
}

std::optional<Expression> Input::optional_expression(std::string_view key, const ExpressionScope& scope,
                                                     const Number& rule) {
  KeyShape shape = key_shape(key, phrase(rule, scope).one, expression_schema(rule), rule.doc, {});
  shape.presence = KeyShape::Presence::optional;
  return read_key(
      *place_, std::move(shape), std::optional<Expression>(),
      [&](const std::string& at, const Json& value) { return check_expression(*place_, at, value, scope, rule); });
}

std::optional<std::vector<Expression>> Input::optional_expressions(std::string_view key, std::size_t size,
                                                                   const ExpressionScope& scope, const Number& rule) {
  const auto check = [&](const std::string& at, const Json& value) {
    return check_expression(*place_, at, value, scope, rule);
  };
  KeyShape shape = list_shape(key, phrase(rule, scope), expression_schema(rule), size, rule.doc, {});
  shape.presence = KeyShape::Presence::optional;
  return read_elements(*place_, std::move(shape), size, std::optional<Expression>(), check);
}

std::map<std::string, double> Input::named_numbers(std::string_view key, std::string_view doc) {
  using Named = std::map<std::string, double>;
  const auto check = [&](const std::string& at, const Json& value) -> std::optional<Named> {
    if (!value.is_object()) place_->note(at, "wrong type", "an object of numbers", value);
    if (!value.is_object()) return {};
    Named named;
    constexpr double harmless_value = 1;  // the name is known, so that the expressions with it are not at fault
    for (const auto& [name, number] : value.items())
      named[name] = checked(*place_, at + "/" + pointer_token(name), number, Number{}).value_or(harmless_value);
    return named;
  };
  const Json schema{{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
  return read_key(*place_, key_shape(key, "an object of numbers", schema, doc, Json::object()), std::optional(Named()),
                  check)
      .value_or(Named());
}

Json Input::raw(std::string_view key, const Json& schema, const Json& fallback) {
  KeyShape shape = key_shape(key, {}, schema, schema.value("description", ""),
                             fallback.is_null() ? std::nullopt : std::optional(fallback));
  shape.presence = KeyShape::Presence::optional;
  const auto as_it_stands = [](const std::string&, const Json& value) { return std::optional(value); };
  return *read_key(*place_, std::move(shape), std::optional(fallback), as_it_stands);
}

}  // namespace minamo
