#include "systems/measure/own_column.hpp"

#include "systems/output/history.hpp"
#include "systems/setup/scene_checks.hpp"

#include <algorithm>

namespace minamo {

void check_own_column(Input& input, const std::string& name, const std::string& thing, Scene& scene) {
  const auto always =
      with_dimension(scene.dimension, [](auto dim) { return history_units<dim()>(measure::Columns()); });
  const auto is_name = [&](const auto& column) { return column.first == name; };
  if (std::any_of(always.begin(), always.end(), is_name)) {
    input.problem("name", "every history has a column of that name", "another name for the " + thing,
                  shown(Json(name)));
    return;
  }
  check_column_name(input, name, thing, scene);
}

}  // namespace minamo
