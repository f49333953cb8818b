#pragma once
/// \file
/// The step of a method as a table, read from top to bottom. A row says where a system stands, and in which scenes.
/// What a part adds has the place of its row; what has no row, as of parts from outside, comes behind those of the
/// slot.

#include "systems/scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace minamo {

/// What must hold of a scene.
struct Condition {
  std::string_view words;       ///< as lists show it
  bool (*holds)(const Scene&);  ///< once all parts have read their keys
};

/// Where a system stands.
struct Row {
  std::string_view slot;            ///< of the step, "start", "output", or the row of a loop
  std::string system;               ///< registered, or `<NAME>`: what a part fills in, Recipe::fill()
  When when = When::always;         ///< in which lists
  std::vector<Condition> all = {};  ///< none: in all scenes
};

/// A standing step: the integrator's place of the weights, the slots up to `solve`, and what follows.
struct StandingRow {
  std::vector<Condition> all;      ///< none: in all scenes
  std::vector<std::string> after;  ///< systems, as in a row
};

/// The step of a method.
struct StepTable {
  std::vector<Row> rows;              ///< by slot, in the order of the step
  std::vector<StandingRow> standing;  ///< before the last one, which gives the first pressure
};

const StepTable& table_of_faces();        ///< the conforming discretization
const StepTable& table_of_equal_order();  ///< equal order
const StepTable& table_of(const Scene& scene);

/// Whether all of them hold.
bool holds(const std::vector<Condition>& all, const Scene& scene);
/// The systems of a slot, of `start`, of `output` or of a loop, in a step or in a standing one.
std::vector<System> systems_of(const Scene& scene, std::string_view slot, When list);
/// One row by its name.
std::vector<System> systems_named(const Scene& scene, const std::string& system, When list);
/// \throws std::logic_error if a part has filled a row that no table has.
void require_rows(const Recipe& recipe);

}  // namespace minamo
