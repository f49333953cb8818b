#include "engine/input/input_place.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

std::string text_of(double value) { return json_number(value).dump(); }
std::string text_of(std::int64_t value) { return std::to_string(value); }

/// One end of a range; `open`: the end itself is outside.
template <class T>
struct End {
  std::optional<T> at;
  bool open = false;
};

template <class T>
std::string range_text(const End<T>& low, const End<T>& high) {
  if (low.at && high.at)
    return std::string(low.open ? " in (" : " in [") + text_of(*low.at) + ", " + text_of(*high.at) +
           (high.open ? ")" : "]");
  if (low.at) return (low.open ? " > " : " >= ") + text_of(*low.at);
  if (high.at) return (high.open ? " < " : " <= ") + text_of(*high.at);
  return {};
}

End<double> low_end(const Number& rule) {
  if (rule.above >= rule.at_least && std::isfinite(rule.above)) return {rule.above, true};
  return std::isfinite(rule.at_least) ? End<double>{rule.at_least} : End<double>{};
}

End<double> high_end(const Number& rule) {
  if (rule.below <= rule.at_most && std::isfinite(rule.below)) return {rule.below, true};
  return std::isfinite(rule.at_most) ? End<double>{rule.at_most} : End<double>{};
}

std::string range_text(const Number& rule) { return range_text(low_end(rule), high_end(rule)); }

/// Nothing for the dimensionless ones: "a number in [0, 1] [1]" would only puzzle.
std::string unit_text(const Number& rule) {
  return rule.unit.empty() || rule.unit == "1" ? "" : fmt::format(" [{}]", rule.unit);
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace

Phrase phrase(const Number& rule) {
  const std::string rest = range_text(rule) + unit_text(rule);
  return {"a number" + rest, "numbers" + rest};
}

Phrase phrase(const Integer& rule) {
  End<std::int64_t> low, high;
  if (rule.at_least != std::numeric_limits<std::int64_t>::min()) low.at = rule.at_least;
  if (rule.at_most != std::numeric_limits<std::int64_t>::max()) high.at = rule.at_most;
  const std::string range = range_text(low, high);
  return {"a whole number" + range, "whole numbers" + range};
}

Phrase phrase(const Number& rule, const ExpressionScope& scope) {
  const std::string names = scope.variables.empty() ? "" : fmt::format(" in {}", joined(scope.variables));
  return {"a number" + range_text(rule) + " or an expression" + names + unit_text(rule),
          "numbers" + range_text(rule) + " or expressions" + names + unit_text(rule)};
}

Json schema_of(const Number& rule) {
  Json schema{{"type", "number"}};
  if (const auto low = low_end(rule); low.at) schema[low.open ? "exclusiveMinimum" : "minimum"] = json_number(*low.at);
  if (const auto high = high_end(rule); high.at)
    schema[high.open ? "exclusiveMaximum" : "maximum"] = json_number(*high.at);
  if (!rule.unit.empty()) schema["x-unit"] = rule.unit;
  return schema;
}

Json schema_of(const Integer& rule) {
  Json schema{{"type", "integer"}};
  if (rule.at_least != std::numeric_limits<std::int64_t>::min()) schema["minimum"] = rule.at_least;
  if (rule.at_most != std::numeric_limits<std::int64_t>::max()) schema["maximum"] = rule.at_most;
  return schema;
}

bool fits(const Number& rule, double value) {
  return std::isfinite(value) && value >= rule.at_least && value <= rule.at_most &&
         (value > rule.above || std::isinf(rule.above)) && (value < rule.below || std::isinf(rule.below));
}

bool fits(const Integer& rule, std::int64_t value) { return value >= rule.at_least && value <= rule.at_most; }

double harmless(const Number& rule) {
  if (rule.fallback) return *rule.fallback;
  const auto low = low_end(rule), high = high_end(rule);
  if (low.at && !low.open) return *low.at;
  if (low.at && high.at) return *low.at + (*high.at - *low.at) / 2;
  if (low.at) return *low.at + 1;
  if (high.at) return high.open ? *high.at - 1 : *high.at;
  return 0;
}

std::int64_t harmless(const Integer& rule) {
  return rule.fallback.value_or(std::clamp(std::int64_t{0}, rule.at_least, rule.at_most));
}

Json json_number(double value) {
  constexpr double all_digits = 1e15;  // below, a double holds every whole number, and dump() writes it out
  const bool negative_zero = value == 0 && std::signbit(value);
  if (std::trunc(value) == value && std::abs(value) < all_digits && !negative_zero)
    return static_cast<std::int64_t>(value);
  return value;
}

std::string one_line(const Json& value) {
  if (!value.is_array()) return value.dump();
  std::string list;
  for (const Json& element : value) list += (list.empty() ? "" : ", ") + one_line(element);
  return "[" + list + "]";
}

}  // namespace minamo
