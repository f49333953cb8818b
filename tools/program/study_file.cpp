#include "tools/program/study_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace minamo {

namespace {

constexpr int most_variants = 1000;  // each has a folder and a run

/// The name can stand for a number in an expression.
bool can_be_variable(const std::string& name) {
  try {
    const Expression expression(name, {{name}, {}});
    return expression.uses(name);
  } catch (const ExpressionError&) {
    return false;
  }
}

bool is_json_pointer(const std::string& text) {
  try {
    const Json::json_pointer pointer(text);
    return !pointer.empty();
  } catch (const Json::exception&) {
    return false;
  }
}

bool is_count(const Json& value) {
  if (!value.is_number()) return false;
  const auto number = value.get<double>();
  return std::trunc(number) == number && number >= 3 && number <= 1e6;
}

/// What is wrong with one value of a parameter that is no pointer; empty if nothing is.
std::string expected_value(const std::string& name, const Json& value) {
  if (name != resolution_key) return value.is_number() ? "" : "a number";
  const bool is_list = value.is_array() && (value.size() == 2 || value.size() == 3);
  const bool fits = is_list ? std::all_of(value.begin(), value.end(), is_count) : is_count(value);
  return fits ? "" : "a whole number >= 3, the cells along x, or a list of them per direction";
}

void check_values(Input& input, const std::string& name, const std::string& key, const std::vector<Json>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string at = fmt::format("{}/{}", key, i);
    const std::string expected = is_pointer(name) ? "" : expected_value(name, values[i]);
    if (!expected.empty()) {
      input.problem(at, "wrong value", expected);
    } else if (std::find(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) !=
               values.begin() + static_cast<std::ptrdiff_t>(i)) {
      input.problem(at, "given twice", "a list of different values");
    }
  }
}

void check_name(Input& input, const std::string& name, const std::string& key) {
  if (is_pointer(name)) {
    if (!is_json_pointer(name)) input.problem(key, "not a JSON pointer", "/key/key, like /transfer/scheme", name);
  } else if (!can_be_variable(name)) {
    input.problem(key, "neither a place nor a name",
                  "a JSON pointer like /transfer/scheme, \"cells\", or a name that time_step uses", shown(Json(name)));
  }
}

std::vector<Parameter> read_parameters(Input& vary) {
  std::vector<Parameter> parameters;
  for (const std::string& name : vary.names("")) {
    const Json values = vary.raw(name, {{"type", "array"}, {"minItems", 1}, {"description", "values"}}, {});
    const std::string key = pointer_token(name);
    check_name(vary, name, key);
    if (!values.is_array() || values.empty()) {
      vary.problem(key, values.is_array() ? "empty list" : "wrong type", "a list of at least one value");
      continue;
    }
    parameters.push_back({name, {values.begin(), values.end()}});
    if (values.size() <= static_cast<std::size_t>(most_variants))
      check_values(vary, name, key, parameters.back().values);
  }
  if (!vary.describing() && vary.names("").empty())
    vary.problem("", "nothing is varied", "at least one list of values");
  return parameters;
}

std::vector<std::pair<std::string, Json>> read_settings(Input& set) {
  std::vector<std::pair<std::string, Json>> settings;
  for (const std::string& name : set.names("")) {
    settings.emplace_back(name, set.raw(name, {{"description", "value"}}, {}));
    if (is_pointer(name) && is_json_pointer(name)) continue;
    set.problem(pointer_token(name), "not a JSON pointer", "/key/key, like /transfer/scheme", shown(Json(name)));
  }
  return settings;
}

/// A name that changes nothing is a misspelt one.
void check_use(Input& input, const Study& study) {
  if (!input.sound("time_step")) return;
  std::vector<std::string> used{std::string(resolution_key)};
  for (const Parameter& parameter : study.parameters) {
    if (is_pointer(parameter.key) || parameter.key == resolution_key) continue;
    if (study.time_step && study.time_step->uses(parameter.key)) continue;
    input.problem("vary/" + pointer_token(parameter.key), "used nowhere",
                  "a JSON pointer like /transfer/scheme, \"cells\", or a name that time_step uses",
                  shown(Json(parameter.key)), closest_name(parameter.key, used));
  }
}

void check_count(Input& input, const Study& study) {
  double count = 1;
  for (const Parameter& parameter : study.parameters) count *= static_cast<double>(parameter.values.size());
  if (count > most_variants)
    input.problem("vary", "too many variants", fmt::format("at most {}", most_variants), fmt::format("{:.0f}", count));
}

Study read(Input& input) {
  Study study;
  study.title = input.text("title", {.doc = "shown in the table and the picture", .fallback = ""});
  study.scene = input.text("scene", {.doc = "scene file, from the folder of the study"});
  input.object("vary", "lists of values, of which every combination is run", Input::Presence::required,
               [&](Input& vary) { study.parameters = read_parameters(vary); });
  input.object("set", "values that all variants have in place of the scene's", Input::Presence::only_if_present,
               [&](Input& set) { study.settings = read_settings(set); });
  study.time_step = input.optional_expression("time_step", {variables_of(study.parameters), {}},
                                              {.unit = "s", .doc = "length of a step", .above = 0});
  study.end = input.optional_number("end", {.unit = "s", .doc = "end of the runs", .above = 0});
  study.error = read_error_measure(input);
  const std::vector<std::string> costs{"wall", "cpu"};
  study.cost = input.choice("cost", costs, "wall time, or processor time per simulated second", "wall") == "wall"
                   ? Cost::wall
                   : Cost::cpu;
  study.repeats = static_cast<int>(input.integer(
      "repeat",
      {.doc = "runs of a variant, of which the cheapest counts", .fallback = 1, .at_least = 1, .at_most = 100}));
  const std::string_view doc = "table of points of others, for the picture";
  if (input.optional_text("others", doc)) study.others = input.path("others", doc).string();
  check_use(input, study);
  check_count(input, study);
  return study;
}

}  // namespace

std::vector<std::string> variables_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    if (!is_pointer(parameter.key) && can_be_variable(parameter.key)) names.push_back(parameter.key);
  }
  return names;
}

Study read_study(const Json& json, const std::string& path) {
  if (json.is_object() && json.contains("grid") && !json.contains("scene")) {
    throw InputError({{path, {}, "is a scene, not a study", "a study; scenes are run by `minamo run`", {}, {}}});
  }
  Input::Document document(json, path);
  Study study = read(document.root());
  document.finish();
  document.require_valid();
  study.file = path;
  study.scene = (std::filesystem::path(path).parent_path() / study.scene).lexically_normal().string();
  return study;
}

Study read_study(const std::string& path) { return read_study(read_json(path), path); }

}  // namespace minamo
