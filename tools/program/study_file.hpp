#pragma once
/// \file
/// A study as plain data, and the one place that reads it. What its variants are is in study_variant.hpp.

#include "engine/input/input.hpp"
#include "tools/program/study_error.hpp"
#include "tools/program/study_table.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace minamo {

/// What a study varies: the values under a key of `vary`.
struct Parameter {
  std::string key;  ///< JSON pointer into the scene, "cells", or a name that time_step uses
  std::vector<Json> values;
};

struct Study {
  std::string file;  ///< as the messages call it
  std::string title;
  std::string scene;  ///< path of the scene file
  std::vector<Parameter> parameters;
  std::vector<std::pair<std::string, Json>> settings;  ///< JSON pointer and value, the same for all variants
  std::optional<Expression> time_step;                 ///< in variables_of(parameters) [s]
  std::optional<double> end;                           ///< [s]
  ErrorMeasure error;
  Cost cost = Cost::wall;
  int repeats = 1;     ///< runs of a variant, of which the cheapest counts
  std::string others;  ///< path of the table of their points; may be empty
};

/// The key of `vary` that is the resolution: N cells along x or a list of counts.
inline constexpr std::string_view resolution_key = "cells";

/// Whether a parameter is a place of the scene.
inline bool is_pointer(const std::string& key) { return key.starts_with("/"); }

/// The names that time_step may use: the parameters that are no pointers, in order.
std::vector<std::string> variables_of(const std::vector<Parameter>& parameters);

/// \throws InputError with all problems of the file.
Study read_study(const std::string& path);
/// The same for a document that is in memory; `path` is what the messages call it.
Study read_study(const Json& json, const std::string& path);

}  // namespace minamo
