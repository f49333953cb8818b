#pragma once
/// \file
/// Whether a step can go on with what a python program has written.

#include "engine/input/problem.hpp"
#include "engine/storage/world.hpp"

#include <optional>

namespace minamo::python {

/// What is not finite. \pre the values are made of doubles.
std::optional<Problem> problem_with_numbers(Storage& column);

/// Places that are not in the grid, in a column of places; none in any other. A place on a wall is moved off it as far
/// as advection would.
std::optional<Problem> problem_with_places(Storage& column, World& world);

}  // namespace minamo::python
