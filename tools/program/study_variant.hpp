#pragma once
/// \file
/// The variants of a study: every combination of its values, each a scene that is ready to run.

#include "tools/program/scene_file.hpp"
#include "tools/program/study_file.hpp"

#include <optional>
#include <string>
#include <vector>

namespace minamo {

struct Variant {
  std::string name;                  ///< of its folder
  std::vector<std::string> values;   ///< as shown, one per parameter of the study
  std::optional<double> resolution;  ///< cells along x, where the study varies them [1]
  SceneFile scene;
};

/// A value as tables and legends show it: text bare, an object as its scheme and what else it has.
std::string value_text(const Json& value);

/// Heads of the columns of the table: the last word of the key that says something; the whole key where two are alike.
std::vector<std::string> short_names(const std::vector<Parameter>& parameters);

/// Counts with equal spacing for `along_x` cells along x, as near as whole numbers come to it.
std::vector<int> equal_cells(const std::vector<double>& low, const std::vector<double>& high, int along_x);

/// Every combination of a study of this scene, the last parameter fastest.
/// \throws InputError with all problems of all variants.
std::vector<Variant> read_variants(const Study& study, const Json& scene, const SystemRegistry& registry);

/// The same for the scene that the study names, with all that is in the way of a run found out as well.
/// \throws InputError, ScheduleError
std::vector<Variant> make_variants(const Study& study, const SystemRegistry& registry);

}  // namespace minamo
