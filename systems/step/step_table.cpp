#include "systems/step/step_table.hpp"

#include "systems/scene/discretization.hpp"

#include <algorithm>

namespace minamo {

namespace {

bool is_in(When when, When list) { return when == When::always || list == When::always || when == list; }

bool is_filled_by_a_part(const std::string& system) { return system.front() == '<'; }

const Recipe::Placed* placed_at(const Recipe& recipe, const Row& row, When list) {
  const auto& placed = recipe.placed();
  const auto found = std::find_if(placed.begin(), placed.end(), [&](const Recipe::Placed& one) {
    return one.slot == row.slot && one.system.name == row.system && is_in(one.when, list);
  });
  return found == placed.end() ? nullptr : &*found;
}

bool has_row(const StepTable& table, const Recipe::Placed& placed, When list) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const Row& row) {
    return row.slot == placed.slot && row.system == placed.system.name && is_in(row.when, list);
  });
}

bool names_row(const StepTable& table, const std::string& system) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const Row& row) { return row.system == system; });
}

}  // namespace

const StepTable& table_of(const Scene& scene) {
  return is_conforming(scene) ? table_of_faces() : table_of_equal_order();
}

bool holds(const std::vector<Condition>& all, const Scene& scene) {
  return std::all_of(all.begin(), all.end(), [&](const Condition& one) { return one.holds(scene); });
}

std::vector<System> systems_named(const Scene& scene, const std::string& system, When list) {
  const Recipe& recipe = scene.recipe;
  if (!is_filled_by_a_part(system)) return {recipe.make(system)};
  const auto maker = recipe.makers().find(system);
  if (maker == recipe.makers().end()) throw std::logic_error("no part fills the row " + system + " of the step");
  return maker->second(systems_of(scene, system, list));
}

std::vector<System> systems_of(const Scene& scene, std::string_view slot, When list) {
  const StepTable& table = table_of(scene);
  std::vector<System> systems;
  for (const Row& row : table.rows) {
    if (row.slot != slot || !is_in(row.when, list)) continue;
    if (const auto* placed = placed_at(scene.recipe, row, list)) {
      systems.push_back(placed->system);
    } else if (holds(row.all, scene)) {
      for (System& system : systems_named(scene, row.system, list)) systems.push_back(std::move(system));
    }
  }
  for (const Recipe::Placed& placed : scene.recipe.placed()) {
    if (placed.slot == slot && is_in(placed.when, list) && !has_row(table, placed, list))
      systems.push_back(placed.system);
  }
  return systems;
}

void require_rows(const Recipe& recipe) {
  for (const auto& [system, make] : recipe.makers()) {
    if (!names_row(table_of_faces(), system) && !names_row(table_of_equal_order(), system))
      throw std::logic_error("no table of the step has the row " + system);
  }
}

}  // namespace minamo
