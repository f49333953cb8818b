#pragma once
/// \file
/// The words for a wall, of a side of the box or of a body: a name, or {"slip_length": 1e-3}.

#include "engine/input/input.hpp"

#include <map>
#include <string>
#include <vector>

namespace minamo {

/// What a wall of a scene may be.
struct WallWords {
  std::vector<std::string> names;       ///< given as a name
  std::vector<std::string> lengths;     ///< given as {name: slip length}
  std::vector<std::string> separating;  ///< of the names, those that let the liquid leave
  bool is_conforming = true;            ///< only that discretization has walls with a length and separating ones
  double shortest = 0;                  ///< length that is told from none [m]
  std::map<std::string, double> constants;
};

/// What a scene says of a wall.
struct WallOfScene {
  std::string condition;
  double length = 0;  ///< of those that have one [m]
};

/// The names that the discretization has, and `more`.
std::vector<std::string> known_names(const WallWords& words, const std::vector<std::string>& more = {});

/// Of {"slip_length": m}.
Json slip_length_schema(const WallWords& words);

/// `at` is the place of the value, as Input::problem() takes it.
/// \param names  those that it may have here
/// \return the first of the words if there is a problem
WallOfScene read_wall(Input& input, const std::string& at, const Json& value, const WallWords& words,
                      const std::vector<std::string>& names);

}  // namespace minamo
