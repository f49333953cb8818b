#pragma once
/// \file
/// The motion of a body as a table of a CSV file: time, x, y[, z][, angle in degrees] per line, since the start.

#include "systems/bodies/body_set.hpp"

#include <filesystem>

namespace minamo {

struct MotionTableError : std::runtime_error {
  MotionTableError(const std::string& what, std::string what_is_right, std::string what_is_there)
      : std::runtime_error(what), expected(std::move(what_is_right)), got(std::move(what_is_there)) {}
  std::string expected;
  std::string got;
};

/// A first line that does not begin with a number is a header; empty lines and those that begin with # are skipped.
/// \throws MotionTableError for a file that cannot be read, a line that is no row, or times that do not rise
template <int Dim>
Tabulated<Dim> read_motion_table(const std::filesystem::path& file);

}  // namespace minamo
