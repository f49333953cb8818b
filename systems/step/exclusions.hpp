#pragma once
/// \file
/// What a scene cannot have together, and why.

#include "engine/input/problem.hpp"
#include "systems/step/step_table.hpp"

namespace minamo {

struct Exclusion {
  std::string_view key;       ///< what has to change, as a JSON pointer
  Condition has;              ///< what the key says
  Condition with;             ///< what that cannot be with, as messages have it
  std::string_view expected;  ///< of the key
  std::string_view got;
  std::string_view why;
};

const std::vector<Exclusion>& exclusions();

/// A problem for every key that has to change, by the first row that says so.
/// \pre the scene was read without problems
std::vector<Problem> exclusions_of(const Scene& scene, const std::string& file);

}  // namespace minamo
