#pragma once
/// \file
/// Names of things whose column of the history is their name itself.

#include "systems/scene/scene.hpp"

namespace minamo {

/// As check_column_name(); nor does the history have a column of that name anyway.
void check_own_column(Input& input, const std::string& name, const std::string& thing, Scene& scene);

}  // namespace minamo
