#include "systems/measure/own_column.hpp"

#include "systems/output/history.hpp"
#include "systems/scene/scene_checks.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace minamo {

namespace {

/// Columns that some histories have, whatever the scene names.
constexpr std::array<std::string_view, 7> at_times{"energy_balance", "surface_energy",    "particles",
                                                   "contact_passes", "contact_unsettled", "error_velocity",
                                                   "error_pressure"};

}  // namespace

void check_own_column(Input& input, const std::string& name, const std::string& thing, Scene& scene) {
  const auto always =
      with_dimension(scene.dimension, [](auto dim) { return history_units<dim()>(measure::Columns()); });
  const auto is_name = [&](const auto& column) { return column.first == name; };
  if (std::any_of(always.begin(), always.end(), is_name) ||
      std::find(at_times.begin(), at_times.end(), name) != at_times.end()) {
    input.problem("name", "histories have a column of that name", "another name for the " + thing, shown(Json(name)));
    return;
  }
  check_column_name(input, name, thing, scene);
}

}  // namespace minamo
