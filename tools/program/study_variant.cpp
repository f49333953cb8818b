#include "tools/program/study_variant.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

namespace minamo {

namespace {

/// What one variant is, before its scene is read.
struct Combination {
  std::string name;
  std::vector<Json> values;
};

/// Letters, digits and what else is harmless in the name of a folder.
std::string folder_word(const std::string& text) {
  std::string word;
  for (const char c : text) {
    const bool is_harmless = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+';
    if (is_harmless) word += c;
    if (!is_harmless && !word.empty() && word.back() != '_') word += '_';
  }
  while (!word.empty() && word.back() == '_') word.pop_back();
  return word;
}

/// A number says what it is of; a word speaks for itself.
std::string part_of_name(const std::string& head, const Json& value) {
  return folder_word(value.is_string() || value.is_object() ? value_text(value) : head + value_text(value));
}

std::vector<Combination> combinations(const Study& study) {
  const std::vector<std::string> heads = short_names(study.parameters);
  std::vector<Combination> all{{}};
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    std::vector<Combination> longer;
    for (const Combination& begun : all) {
      for (const Json& value : study.parameters[k].values) {
        Combination next = begun;
        next.values.push_back(value);
        if (!next.name.empty()) next.name += '_';
        next.name += part_of_name(heads[k], value);
        longer.push_back(std::move(next));
      }
    }
    all = std::move(longer);
  }
  std::set<std::string> taken;
  for (Combination& one : all) {
    const std::string wanted = one.name;
    for (int again = 2; !taken.insert(one.name).second; ++again) one.name = fmt::format("{}-{}", wanted, again);
  }
  return all;
}

double along_x(const Json& cells) { return (cells.is_array() ? cells[0] : cells).get<double>(); }

/// Sets the counts, where the box of the scene is there to tell those across x; if not, reading the scene says so.
void set_cells(Json& scene, const Json& cells, const std::string& file) {
  Json counts = cells;
  if (!cells.is_array()) {
    std::vector<double> low;
    std::vector<double> high;
    try {
      const Json& grid = scene.at("grid");
      grid.at("low").get_to(low);
      grid.at("high").get_to(high);
    } catch (const Json::exception&) {
      return;
    }
    if (low.size() != high.size() || low.empty()) return;
    counts = equal_cells(low, high, cells.get<int>());
  }
  set_value(scene, "/grid/cells", counts, file);
}

/// The values that the variables of the study have in a variant.
std::vector<double> variables(const Study& study, const Combination& combination) {
  std::vector<double> values;
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    if (is_pointer(study.parameters[k].key)) continue;
    values.push_back(along_x(combination.values[k]));
  }
  return values;
}

void set_time_step(Json& scene, const Study& study, const Combination& combination, const std::string& file) {
  if (!study.time_step) return;
  const std::vector<double> values = variables(study, combination);
  const double step = (*study.time_step)(values);
  if (!std::isfinite(step) || step <= 0) {
    std::string got = fmt::format("{} s", step);
    const std::vector<std::string> names = variables_of(study.parameters);
    for (std::size_t k = 0; k < names.size(); ++k)
      got += fmt::format("{}{} = {}", k == 0 ? " with " : ", ", names[k], values[k]);
    throw InputError({{study.file, "/time_step", "not a time step", "a number > 0 [s]", got, {}}});
  }
  set_value(scene, "/time/step", step, file);
  for (const char* other : {"cfl", "max_step"}) scene["time"].erase(other);
}

/// The document of the scene with what the study and the variant change.
Json scene_of(const Json& scene, const Study& study, const Combination& combination, const std::string& file,
              const SystemRegistry& registry) {
  Json changed = scene;
  std::set<std::string> overridden;
  const auto set = [&](const std::string& pointer, const Json& value) {
    set_value(changed, pointer, value, file);
    overridden.insert(pointer);
  };
  for (const auto& [pointer, value] : study.settings) set(pointer, value);
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    if (is_pointer(study.parameters[k].key)) set(study.parameters[k].key, combination.values[k]);
  }
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    if (study.parameters[k].key == resolution_key) set_cells(changed, combination.values[k], file);
  }
  set_time_step(changed, study, combination, file);
  if (study.end) set_value(changed, "/time/end", *study.end, file);
  drop_keys_of_replaced_schemes(changed, overridden, registry);
  return changed;
}

/// Problems of several variants, each told once with the first variant that has it.
class Problems {
 public:
  /// \param variant_file  what the problems call the variant's scene.
  void add(const InputError& error, const std::string& variant_file) {
    for (const Problem& problem : error.problems()) {
      Problem general = problem;
      if (general.file == variant_file) general.file.clear();
      if (told_.insert(general.text()).second) problems_.push_back(problem);
    }
  }
  /// \throws InputError if there are any.
  void refuse_any() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  std::set<std::string> told_;
  std::vector<Problem> problems_;
};

/// What the messages call the scene of a variant.
std::string file_of(const Study& study, const std::string& variant) {
  return fmt::format("{}: variant {}", study.scene, variant);
}

/// \throws InputError
Variant make_variant(const Json& scene, const Study& study, const Combination& combination, const std::string& file,
                     const SystemRegistry& registry) {
  Variant variant;
  variant.name = combination.name;
  variant.scene = understand_scene(scene_of(scene, study, combination, file, registry), file, registry);
  const auto missing = missing_for(study.error, variant.scene.scene, study.file);
  if (!missing.empty()) throw InputError(missing);
  for (std::size_t k = 0; k < combination.values.size(); ++k) {
    variant.values.push_back(value_text(combination.values[k]));
    if (study.parameters[k].key == resolution_key) variant.resolution = along_x(combination.values[k]);
  }
  return variant;
}

/// The scene of a study. That it is missing is a problem of the study. \throws InputError
Json scene_json(const Study& study) {
  try {
    return read_json(study.scene);
  } catch (const InputError& error) {
    if (std::filesystem::exists(study.scene)) throw;
    const Problem& missing = error.problems().front();
    throw InputError({{study.file, "/scene", missing.what, "a scene file, from the folder of the study",
                       minamo::shown(Json(study.scene)), missing.closest}});
  }
}

}  // namespace

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_object()) return value.dump();
  std::string text;
  for (const auto& [key, content] : value.items()) {
    if (!text.empty()) text += ' ';
    if (key != "scheme") text.append(key).append("=");
    text += value_text(content);
  }
  return text;
}

std::vector<std::string> short_names(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    std::string name = parameter.key;
    if (name.ends_with("/scheme")) name.erase(name.rfind('/'));
    names.push_back(name.substr(name.rfind('/') + 1));
  }
  std::vector<std::string> unlike = names;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].empty() || std::count(names.begin(), names.end(), names[k]) > 1) unlike[k] = parameters[k].key;
  }
  return unlike;
}

std::vector<int> equal_cells(const std::vector<double>& low, const std::vector<double>& high, int along_x) {
  std::vector<int> cells{along_x};
  for (std::size_t d = 1; d < low.size(); ++d) {
    const double wanted = along_x * (high[d] - low[d]) / (high[0] - low[0]);
    constexpr double most = 1e9;  // reading the scene refuses less than that
    cells.push_back(static_cast<int>(std::isfinite(wanted) ? std::clamp(std::round(wanted), 0.0, most) : 0.0));
  }
  return cells;
}

std::vector<Variant> read_variants(const Study& study, const Json& scene, const SystemRegistry& registry) {
  std::vector<Variant> variants;
  Problems problems;
  for (const Combination& combination : combinations(study)) {
    const std::string file = file_of(study, combination.name);
    try {
      variants.push_back(make_variant(scene, study, combination, file, registry));
    } catch (const InputError& error) {
      problems.add(error, file);
    }
  }
  problems.refuse_any();
  return variants;
}

std::vector<Variant> make_variants(const Study& study, const SystemRegistry& registry) {
  std::vector<Variant> variants = read_variants(study, scene_json(study), registry);
  Problems problems;
  for (const Variant& variant : variants) {
    const std::string file = file_of(study, variant.name);
    try {
      rehearse(variant.scene.scene, file);
    } catch (const InputError& error) {
      problems.add(error, file);
    }
  }
  problems.refuse_any();
  return variants;
}

}  // namespace minamo
