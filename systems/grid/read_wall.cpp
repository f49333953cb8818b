#include "systems/grid/read_wall.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

/// What reads {"slip_length": 1e-3}, once for values, messages and schema.
WallOfScene read_length(Input& input, const WallWords& words) {
  WallOfScene side;
  Input::Variants variants;
  for (const std::string& name : words.lengths) {
    variants.emplace_back(name, [&, name](Input& in) {
      const double length =
          in.number(name, {.unit = "m", .doc = "depth below the wall at which the velocity would vanish", .above = 0});
      side = {name, length};
    });
  }
  input.one_of("a wall that rubs", variants);
  return side;
}

/// The problems of an object of its own are those of the scene at a place.
WallOfScene read_length_at(Input& input, const std::string& at, const Json& value, const WallWords& words) {
  if (!words.is_conforming) {
    input.problem(
        at, "a slip length needs the conforming discretization",
        fmt::format(R"({}, or "discretization": {{"scheme": "conforming"}})", one_of_text(known_names(words))),
        shown(value));
    return {words.names.front()};
  }
  Input::Document document(value, "");
  document.root().use_constants(words.constants);
  WallOfScene side = read_length(document.root(), words);
  document.finish();
  for (const Problem& problem : document.problems()) {
    input.problem(at + problem.pointer, problem.what, problem.expected, problem.got, problem.closest);
  }
  if (!document.problems().empty()) return {words.names.front()};
  if (side.length >= words.shortest) return side;
  input.problem(at, "a slip length that is none", fmt::format(R"(at least {:.3g} m, or "no_slip")", words.shortest),
                shown(value));
  return {words.names.front()};
}

}  // namespace

std::vector<std::string> known_names(const WallWords& words, const std::vector<std::string>& more) {
  std::vector<std::string> known;
  for (const std::string& name : words.names) {
    const bool separates = std::find(words.separating.begin(), words.separating.end(), name) != words.separating.end();
    if (words.is_conforming || !separates) known.push_back(name);
  }
  known.insert(known.end(), more.begin(), more.end());
  return known;
}

namespace {

/// What a wall may be.
std::string expected_wall(const WallWords& words, const std::vector<std::string>& names) {
  std::string expected = one_of_text(names);
  if (!words.is_conforming) return expected;
  for (const std::string& name : words.lengths) expected += fmt::format(R"(, or {{"{}": m}})", name);
  return expected;
}

}  // namespace

Json slip_length_schema(const WallWords& words) {
  auto description = Input::Document::describe();
  description.root().use_constants({});
  read_length(description.root(), words);
  Json schema = description.schema();
  schema.erase("$schema");
  return schema;
}

WallOfScene read_wall(Input& input, const std::string& at, const Json& value, const WallWords& words,
                      const std::vector<std::string>& names) {
  if (value.is_object()) return read_length_at(input, at, value, words);
  const std::string name = value.is_string() ? value.get<std::string>() : "";
  if (std::find(names.begin(), names.end(), name) != names.end()) return {name};
  const bool separates = std::find(words.separating.begin(), words.separating.end(), name) != words.separating.end();
  if (separates && !words.is_conforming) {
    input.problem(at, "a wall that the liquid may leave needs the conforming discretization",
                  fmt::format(R"({}, or "discretization": {{"scheme": "conforming"}})", one_of_text(names)),
                  shown(value));
  } else {
    input.problem(at, value.is_string() ? "unknown name" : "wrong type", expected_wall(words, names), shown(value),
                  input.closest(name, names));
  }
  return {names.front()};
}

}  // namespace minamo
